//! The colours of the game.

use egui::Color32;

/// The colours of the game.
#[derive(Clone, Debug, PartialEq)]
pub struct Theme {
    /// Behind everything.
    pub paper: Color32,
    /// Letters.
    pub ink: Color32,
    /// Letters that matter less.
    pub faint: Color32,
    /// A card on the paper.
    pub card: Color32,
    /// A button.
    pub button: Color32,
    /// The button that is meant.
    pub accent: Color32,
    /// Letters on it.
    pub on_accent: Color32,
    /// What has done well.
    pub good: Color32,
    /// The world.
    pub world: fuwafuwa_render::Palette,
}

impl Theme {
    /// The colour of a material.
    pub fn material(&self, number: u8) -> Color32 {
        colour(self.world.material(number))
    }

    /// The colour of a player's hand.
    pub fn hand(&self, player: usize) -> Color32 {
        colour(self.world.hand(player))
    }

    /// The colour of elements of a level.
    pub fn level(&self, level: u8) -> Color32 {
        colour(self.world.level(level))
    }

    /// The colour of a strain.
    pub fn strain(&self, strain: f32) -> Color32 {
        colour(self.world.strain(strain))
    }

    /// The usual colours, or those that nobody mixes up [Okabe 2008].
    pub fn of(colour_safe: bool) -> Self {
        let rgb = Color32::from_rgb;
        let usual = Self {
            paper: rgb(255, 250, 240),
            ink: rgb(74, 54, 52),
            faint: rgb(146, 122, 112),
            card: rgb(255, 255, 255),
            button: rgb(255, 236, 214),
            accent: rgb(240, 108, 98),
            on_accent: rgb(255, 255, 255),
            good: rgb(87, 168, 92),
            world: fuwafuwa_render::Palette::candy(),
        };
        match colour_safe {
            false => usual,
            true => Self {
                accent: rgb(213, 94, 0),
                good: rgb(0, 114, 178),
                world: fuwafuwa_render::Palette::colour_safe(),
                ..usual
            },
        }
    }
}

fn colour(of: fuwafuwa_render::Colour) -> Color32 {
    let [red, green, blue] = of.map(|k| (255.0 * k + 0.5) as u8);
    Color32::from_rgb(red, green, blue)
}
