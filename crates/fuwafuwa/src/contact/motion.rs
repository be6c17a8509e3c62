//! The velocities that contacts push on, side by side.

use super::{Grip, NodeContact, push_hand};
use crate::body::Body;
use crate::dim::Dim;
use crate::manipulator::Manipulator;
use crate::solve::Row;
use crate::touch::mean;
use crate::vector::{as_row, minus, plus, scaled};

/// The velocities of all nodes side by side [m/s], one over their mass as the fourth component
/// [1/kg]: what a push needs is in one place.
#[derive(Clone, Debug, Default)]
pub struct Motion {
    pub rows: Vec<Row>,
}

impl Motion {
    /// Takes the velocities from the bodies.
    pub fn load<D: Dim>(&mut self, bodies: &[Body<D>]) {
        self.rows.clear();
        for body in bodies {
            let nodes = body.velocity.iter().zip(&body.lightness);
            let rows = nodes.map(|(velocity, &lightness)| with_fourth(*velocity, lightness));
            self.rows.extend(rows);
        }
    }

    /// Gives them back.
    pub fn store<D: Dim>(&self, bodies: &mut [Body<D>]) {
        let mut rest = &self.rows[..];
        for body in bodies.iter_mut().filter(|_| !self.rows.is_empty()) {
            let (own, others) = rest.split_at(body.velocity.len());
            rest = others;
            for (velocity, row) in body.velocity.iter_mut().zip(own) {
                *velocity = with_fourth(*row, 0.0);
            }
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
