//! The velocities that contacts push on, side by side.

use super::{Grip, NodeContact, push_hand};
use crate::body::Body;
use crate::dim::Dim;
use crate::manipulator::Manipulator;
use crate::solve::Row;
use crate::touch::{Skin, mean};
use crate::vector::{as_row, minus, plus, scaled};

/// The velocities of the nodes that contacts push on [m/s], one over their mass as the fourth
/// component [1/kg]: what a push needs is in one place.
#[derive(Clone, Debug, Default)]
pub struct Motion {
    /// By place of the node among those of all bodies; of those that nothing touches, anything.
    rows: Vec<Row>,
    /// Place of the first node of each body.
    first: Vec<u32>,
    /// The nodes that something touches, each once: body and place. Of a large body they are few.
    touched: Vec<(u32, u32)>,
    is_touched: Vec<bool>,
}

impl Motion {
    /// Nothing is touched yet.
    pub fn clear<D: Dim>(&mut self, bodies: &[Body<D>]) {
        for (_, place) in self.touched.drain(..) {
            self.is_touched[place as usize] = false;
        }
        self.first.clear();
        let mut count = 0;
        for body in bodies {
            self.first.push(count as u32);
            count += body.velocity.len();
        }
        self.rows.resize(count, [0.0; 4]);
        self.is_touched.resize(count, false);
    }

    /// The place of a node of a body, which something touches, among those of all.
    #[inline(always)]
    pub fn place(&mut self, body: u32, node: u32) -> u32 {
        let place = self.first[body as usize] + node;
        let is_touched = &mut self.is_touched[place as usize];
        if !*is_touched {
            *is_touched = true;
            self.touched.push((body, place));
        }
        place
    }

    /// The places of the corner nodes of a skin that something touches.
    pub fn grip<D: Dim>(&mut self, skin: &Skin) -> Grip {
        let mut grip = [0; 8];
        for (place, &node) in grip.iter_mut().zip(&skin.nodes[..D::CORNERS]) {
            *place = self.place(skin.body, node);
        }
        grip
    }

    /// Takes the velocities from the bodies.
    pub fn load<D: Dim>(&mut self, bodies: &[Body<D>]) {
        for &(body, place) in &self.touched {
            let node = (place - self.first[body as usize]) as usize;
            let body = &bodies[body as usize];
            self.rows[place as usize] = with_fourth(body.velocity[node], body.lightness[node]);
        }
    }

    /// Gives them back.
    pub fn store<D: Dim>(&self, bodies: &mut [Body<D>]) {
        for &(body, place) in &self.touched {
            let node = (place - self.first[body as usize]) as usize;
            let row = self.rows[place as usize];
            bodies[body as usize].velocity[node] = with_fourth(row, 0.0);
        }
    }

    /// How fast the first skin moves as seen from the second.
    #[inline(always)]
    pub fn between<D: Dim>(&self, grips: &[Grip; 2]) -> Row {
        let [first, second] = grips.each_ref().map(|grip| mean::<D>(&self.rows, grip));
        with_fourth(minus(first, second), 0.0)
    }

    /// Pushes the first skin, and the second the other way.
    #[inline(always)]
    pub fn push_skins<D: Dim>(&mut self, grips: &[Grip; 2], impulse: Row) {
        let share = scaled(impulse, 1.0 / D::CORNERS as f32);
        for (grip, share) in [(&grips[0], share), (&grips[1], scaled(share, -1.0))] {
            for &node in &grip[..D::CORNERS] {
                let row = &mut self.rows[node as usize];
                *row = plus(*row, scaled(share, row[3]));
            }
        }
    }

    /// How fast a node moves as seen from what it touches.
    #[inline(always)]
    pub fn of_node(&self, row: &NodeContact, hands: &[Manipulator]) -> Row {
        let own = self.rows[row.node as usize];
        let other = row
            .hand
            .map_or([0.0; 4], |hand| as_row(hands[hand as usize].velocity));
        with_fourth(minus(own, other), 0.0)
    }

    /// Pushes a node, and the hand that touches it the other way.
    #[inline(always)]
    pub fn push_node(
        &mut self,
        row: &NodeContact,
        hands: &mut [Manipulator],
        impulse: Row,
        duration: f32,
    ) {
        let own = &mut self.rows[row.node as usize];
        *own = plus(*own, scaled(impulse, own[3]));
        if let Some(hand) = row.hand {
            push_hand(&mut hands[hand as usize], scaled(impulse, -1.0), duration);
        }
    }
}

#[inline(always)]
fn with_fourth(row: Row, fourth: f32) -> Row {
    [row[0], row[1], row[2], fourth]
}
