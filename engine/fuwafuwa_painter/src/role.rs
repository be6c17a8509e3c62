//! Roles of shapes, and their colours.
//!
//! The colours of levels run from coral through cream to blue. Neighbours differ in lightness or along the
//! blue-yellow axis, so that they can be told apart with most kinds of colour vision. `Added` and `Removed`
//! have a blue and a vermilion after [Okabe 2008]. Pictures also give these two roles different shapes.

/// Colour as red, green and blue (sRGB), 0 to 255 each.
pub type Colour = [u8; 3];

/// Meaning of a shape, which determines its colour.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Role {
    /// Background of a picture.
    Paper,
    /// Text and outlines.
    Ink,
    /// Less important text.
    Faded,
    /// Auxiliary lines of a figure.
    Guide,
    /// A cell of the hierarchy without an element of its own.
    EmptyCell,
    /// Element of a level; level 0 is the finest.
    Level(u8),
    /// The edge of an element.
    Edge,
    /// A node.
    Node,
    /// Mid node: a node in the middle of an edge or a face of an element.
    MidNode,
    /// Element or node that a change of the mesh added.
    Added,
    /// Element or node that a change of the mesh removed or is about to remove.
    Removed,
    /// Object to which the figure draws attention.
    Marked,
    /// Crack faces; in 2D the edges of a crack.
    Crack,
    /// Surface of a body; in 2D also its first material.
    Skin,
    /// Material of a body, by its number from 1.
    Material(u8),
    /// Surface that was inside before the body tore.
    TornSurface,
    /// A crumb: a piece of one voxel.
    Crumb,
    /// A fixed rigid body.
    Obstacle,
    /// The player's hand.
    Hand,
    /// The floor of a 3D scene.
    Floor,
}

const LEVELS: [Colour; 6] = [
    [0xE8, 0x7A, 0x63],
    [0xF5, 0xB0, 0x83],
    [0xFB, 0xE3, 0xAE],
    [0xC3, 0xE1, 0xD9],
    [0x8C, 0xBF, 0xD1],
    [0x6A, 0x97, 0xBF],
];

/// Colours of a body's materials from number 2 on; they repeat after the last.
const MATERIALS: [Colour; 4] = [
    [0xB5, 0x5D, 0x6B],
    [0xF6, 0xCE, 0x8A],
    [0x8F, 0xB8, 0x9B],
    [0x8C, 0xA6, 0xC9],
];

/// Returns the colour of a role.
pub fn colour(role: Role) -> Colour {
    match role {
        Role::Paper => [0xFF, 0xFD, 0xFA],
        Role::Ink => [0x3D, 0x3A, 0x4B],
        Role::Faded => [0x8C, 0x87, 0x93],
        Role::Guide => [0xE9, 0xE4, 0xE0],
        Role::EmptyCell => [0xF3, 0xEF, 0xEB],
        Role::Level(level) => LEVELS[usize::from(level).min(LEVELS.len() - 1)],
        Role::Edge => [0x7D, 0x5A, 0x5A],
        Role::Node => [0x4E, 0x45, 0x52],
        Role::MidNode => [0x2F, 0x6D, 0xA8],
        Role::Added => [0x00, 0x72, 0xB2],
        Role::Removed | Role::Crack => [0xD5, 0x3E, 0x00],
        Role::Marked => [0x2B, 0x27, 0x38],
        Role::Skin | Role::Material(0..=1) => [0xF2, 0x9C, 0x8C],
        Role::Material(number) => MATERIALS[usize::from(number - 2) % MATERIALS.len()],
        Role::TornSurface => [0xFB, 0xDD, 0xA2],
        Role::Crumb => [0xF6, 0xBE, 0x92],
        Role::Obstacle => [0xA9, 0xAF, 0xBC],
        Role::Hand => [0x4A, 0x76, 0xA8],
        Role::Floor => [0xF1, 0xED, 0xE7],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_differ_between_neighbouring_levels() {
        for level in 0..5 {
            let (a, b) = (colour(Role::Level(level)), colour(Role::Level(level + 1)));
            let apart: i32 = (0..3)
                .map(|k| (i32::from(a[k]) - i32::from(b[k])).abs())
                .sum();
            assert!(apart > 70, "levels {level} and {}: {apart}", level + 1);
        }
    }
}
