//! Time since each element was last remodelled.

use fuwafuwa::inspect::Element;
use fuwafuwa::{Dim, ElementId, SoftBodyHandle, World};

/// Properties of an element that remodelling changes: cell position, level and child mask.
type Form = ([i32; 3], u8, u8);

/// Time since each element was last remodelled, found by comparing the mesh between calls.
#[derive(Clone, Debug, Default)]
pub struct Ages {
    bodies: Vec<SoftBodyHandle>,
    forms: Vec<Vec<Option<Form>>>,
    /// Ages [s], by body and element id, as [`crate::Look::Elements`] takes them.
    pub seconds: Vec<Vec<f32>>,
}

impl Ages {
    /// Compares a world with its state in the previous call, `duration` [s] ago. The first call gives every
    /// element a high age, as if it had not been remodelled recently.
    pub fn update<D: Dim>(&mut self, world: &World<D>, duration: f32) {
        let known = std::mem::take(&mut self.bodies);
        let mut forms_before = std::mem::take(&mut self.forms);
        let mut ages_before = std::mem::take(&mut self.seconds);
        for (id, body) in world.soft_bodies() {
            let before = known.iter().position(|&known| known == id);
            let young = before.map_or(f32::MAX, |_| 0.0);
            let of = |before: usize| std::mem::take(&mut forms_before[before]);
            let mut forms = before.map_or_else(Vec::new, of);
            let of = |before: usize| std::mem::take(&mut ages_before[before]);
            let mut ages = before.map_or_else(Vec::new, of);
            let capacity = body.mesh().element_capacity();
            forms.resize(capacity, None);
            ages.resize(capacity, young);
            let all = forms.iter_mut().zip(&mut ages).zip(0..);
            for ((known, age), id) in all {
                let form = body.mesh().element(ElementId(id)).map(form);
                *age = match form == *known {
                    true => *age + duration,
                    false => young,
                };
                *known = form;
            }
            self.bodies.push(id);
            self.forms.push(forms);
            self.seconds.push(ages);
        }
    }
}

fn form(element: &Element) -> Form {
    (element.cell.at, element.cell.level, element.children)
}

#[cfg(test)]
mod tests {
    use super::*;
    use fuwafuwa::{Blade, Dim2, Material, SoftBody, Vec2, VoxelGrid, WorldConfig};

    #[test]
    fn age_restarts_for_elements_remodelled_by_a_cut() {
        let mut world = World::<Dim2>::new(WorldConfig::default()).unwrap();
        let grid = VoxelGrid::ball(32, 1.0).unwrap();
        let id = world
            .add_soft_body(SoftBody::new(grid, &[Material::default()]).unwrap())
            .unwrap();
        let mut ages = Ages::default();
        ages.update(&world, 0.0);
        let young = |ages: &Ages| ages.seconds[0].iter().filter(|&&age| age < 0.2).count();
        assert_eq!(young(&ages), 0);
        let blade = Blade::segment(Vec2::splat(0.5), Vec2::new(0.5, 2.0));
        world.cut(id, &blade).unwrap();
        ages.update(&world, 0.1);
        let remodelled = young(&ages);
        assert!(
            remodelled > 10 && remodelled < ages.seconds[0].len(),
            "{remodelled}"
        );
        ages.update(&world, 0.3);
        assert_eq!(young(&ages), 0);
    }
}
