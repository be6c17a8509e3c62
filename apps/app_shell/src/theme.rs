//! Colours of the interface and the world.

use egui::Color32;

/// Colours of the interface and the world.
#[derive(Clone, Debug, PartialEq)]
pub struct Theme {
    /// Colour of the background.
    pub paper: Color32,
    /// Colour of text.
    pub ink: Color32,
    /// Colour of less important text.
    pub faint: Color32,
    /// Colour of cards: panels on the background.
    pub card: Color32,
    /// Colour of buttons.
    pub button: Color32,
    /// Colour of the main button and of highlights.
    pub accent: Color32,
    /// Colour of text on [`Theme::accent`].
    pub on_accent: Color32,
    /// Colour that stands for success.
    pub good: Color32,
    /// Colours of bodies, hands and other parts of the simulated world.
    pub world: fuwafuwa_render::Palette,
}

impl Theme {
    /// Returns the colour of a material by its number, starting at 1.
    pub fn material(&self, number: u8) -> Color32 {
        colour(self.world.material(number))
    }

    /// Returns the colour of a player's hand.
    pub fn hand(&self, player: usize) -> Color32 {
        colour(self.world.hand(player))
    }

    /// Returns the colour of elements by their level; level 0 is the finest.
    pub fn level(&self, level: u8) -> Color32 {
        colour(self.world.level(level))
    }

    /// Returns the colour of an element by its strain (dimensionless).
    pub fn strain(&self, strain: f32) -> Color32 {
        colour(self.world.strain(strain))
    }

    /// Returns the usual theme, or the theme for colour-blind users [Okabe 2008].
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
