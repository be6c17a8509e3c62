//! Crayons: materials that a drawing names by number.

use fuwafuwa_scenes::scene::{MAX_MATERIALS, MaterialText};
use tamaire_play::playground::Stuff;

/// Materials of a drawing. The crayons come first, in the order of [`Stuff::ALL`]; the other materials of a body that was
/// brought to the paper follow.
#[derive(Clone, Debug, PartialEq)]
pub struct Palette(Vec<MaterialText>);

impl Default for Palette {
    fn default() -> Self {
        Self(Stuff::ALL.map(crayon).into())
    }
}

/// Returns the material of a crayon with its colour. Biscuits are tougher than in a playground, because drawings have thin
/// legs and tails that must withstand a fall.
pub fn crayon(stuff: Stuff) -> MaterialText {
    let colour = match stuff {
        Stuff::Jelly => [240, 110, 130],
        Stuff::Rubber => [90, 165, 220],
        Stuff::Biscuit => [232, 186, 110],
        Stuff::Clay => [150, 175, 110],
        Stuff::Stone => [140, 140, 150],
        Stuff::Caramel => [176, 96, 44],
        Stuff::Dough => [246, 230, 202],
    };
    let material = stuff.material();
    let [strength, toughness] = match stuff {
        Stuff::Biscuit => [Some(6000.0), Some(450.0)],
        _ => [material.strength, material.toughness],
    };
    MaterialText {
        colour: Some(colour),
        strength,
        toughness,
        ..material
    }
}

impl Palette {
    /// Returns the materials, number 1 first.
    pub fn materials(&self) -> &[MaterialText] {
        &self.0
    }

    /// Returns the colour of a crayon: red, green and blue. Materials without a colour are grey.
    pub fn colour(&self, number: u8) -> [u8; 3] {
        let material = usize::from(number)
            .checked_sub(1)
            .and_then(|at| self.0.get(at));
        material
            .and_then(|material| material.colour)
            .unwrap_or([190, 180, 175])
    }

    /// Returns the number of a material, and adds the material if it is new. `None` if the palette is full.
    pub fn number_of(&mut self, material: &MaterialText) -> Option<u8> {
        number_in(&mut self.0, material)
    }

    /// Returns a palette with the crayons and with those materials whose numbers `is_used` contains, and the new number of
    /// each material.
    pub fn with_used(&self, is_used: &[bool; 256]) -> (Self, [u8; 256]) {
        let mut kept = Self::default();
        let mut numbers = [1; 256];
        numbers[0] = 0;
        for (number, material) in (1..=u8::MAX).zip(&self.0) {
            if is_used[usize::from(number)] {
                numbers[usize::from(number)] = kept.number_of(material).unwrap_or(1);
            }
        }
        (kept, numbers)
    }
}

/// Returns the number of `material` in a list, counted from 1, and adds the material if it is new. `None` if the list has
/// as many materials as a scene may have.
pub fn number_in(list: &mut Vec<MaterialText>, material: &MaterialText) -> Option<u8> {
    let known = list.iter().position(|known| known == material);
    if known.is_none() && list.len() >= MAX_MATERIALS {
        return None;
    }
    let place = known.unwrap_or_else(|| {
        list.push(material.clone());
        list.len() - 1
    });
    u8::try_from(place + 1).ok()
}

/// Returns run lengths of cells or voxels with other numbers of materials.
pub(crate) fn renumbered_runs(runs: &str, number: impl Fn(u8) -> u8) -> String {
    let renumbered = |run: &str| {
        let (length, found) = run.split_once('x')?;
        Some(format!("{length}x{}", number(found.parse().ok()?)))
    };
    let runs = runs.split_ascii_whitespace();
    let runs = runs.map(|run| renumbered(run).unwrap_or_else(|| run.to_owned()));
    runs.collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stiff(young: u16) -> MaterialText {
        MaterialText {
            young: Some(f64::from(young)),
            ..MaterialText::default()
        }
    }

    #[test]
    fn palette_numbers_crayons_as_the_playground_does() {
        let mut palette = Palette::default();
        for stuff in Stuff::ALL {
            assert_eq!(palette.number_of(&crayon(stuff)), Some(stuff.number()));
        }
        assert_eq!(palette.materials().len(), Stuff::ALL.len());
    }

    #[test]
    fn materials_of_a_new_level_are_the_crayons() {
        for dim in [2, 3] {
            let draft = crate::draft::Draft::blank(dim);
            assert_eq!(draft.scene().material, Stuff::ALL.map(crayon));
        }
    }

    #[test]
    fn full_palette_takes_no_further_material() {
        let mut palette = Palette::default();
        for young in 1..400 {
            let is_full = palette.materials().len() == MAX_MATERIALS;
            assert_eq!(palette.number_of(&stiff(young)).is_none(), is_full);
        }
        assert_eq!(palette.materials().len(), MAX_MATERIALS);
    }

    #[test]
    fn palette_keeps_the_crayons_and_the_used_materials() {
        let mut palette = Palette::default();
        let crayons = palette.materials().len();
        let [_, used, _] = [1, 2, 3].map(|young| palette.number_of(&stiff(young)).unwrap());
        let mut is_used = [false; 256];
        is_used[2] = true;
        is_used[usize::from(used)] = true;
        let (kept, numbers) = palette.with_used(&is_used);
        assert_eq!(kept.materials().len(), crayons + 1);
        assert_eq!(kept.materials().last(), Some(&stiff(2)));
        assert_eq!((numbers[0], numbers[2]), (0, 2));
        assert_eq!(usize::from(numbers[usize::from(used)]), crayons + 1);
    }
}
