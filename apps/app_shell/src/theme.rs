//! Colours of the interface and the world. Text has a contrast of at least 4.5 : 1 on each ground that it is
//! drawn on, in both themes.

use egui::Color32;

/// Background of pages, which are opaque. Over a world, the same colour is translucent; see [`dimmed`].
pub const PAGE: Color32 = Color32::from_rgb(255, 248, 238);

/// Opacity of [`PAGE`] over a world that text is drawn on without a card, 0 to 255. With less, the world would
/// be too dark for text in the colour [`Theme::accent`].
pub const DIMMED: u8 = 80;

/// Returns the colour of `world` behind [`PAGE`] of the opacity `strength`, 0 to 255.
pub fn dimmed(world: Color32, strength: u8) -> Color32 {
    world.blend(PAGE.gamma_multiply_u8(strength))
}

/// Returns the contrast of two opaque colours, 1 (none) to 21 (black on white) [WCAG 2.2, contrast ratio].
pub fn contrast(one: Color32, other: Color32) -> f32 {
    let [one, other] = [luminance(one), luminance(other)];
    (one.max(other) + 0.05) / (one.min(other) + 0.05)
}

/// Returns the relative luminance of an opaque colour, 0 (black) to 1 (white) [WCAG 2.2, relative luminance].
fn luminance(of: Color32) -> f32 {
    let linear = |part: u8| match f32::from(part) / 255.0 {
        dark if dark <= 0.04045 => dark / 12.92,
        light => ((light + 0.055) / 1.055).powf(2.4),
    };
    0.2126 * linear(of.r()) + 0.7152 * linear(of.g()) + 0.0722 * linear(of.b())
}

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

    /// Returns the usual theme, or the theme for colour-blind users. Its colours are those of [Okabe 2008], the
    /// vermilion and the blue darkened for the contrast of text.
    pub fn of(colour_safe: bool) -> Self {
        let rgb = Color32::from_rgb;
        let usual = Self {
            paper: rgb(255, 250, 240),
            ink: rgb(74, 54, 52),
            faint: rgb(124, 101, 92),
            card: rgb(255, 255, 255),
            button: rgb(255, 236, 214),
            accent: rgb(190, 57, 50),
            on_accent: rgb(255, 255, 255),
            good: rgb(44, 122, 56),
            world: fuwafuwa_render::Palette::candy(),
        };
        match colour_safe {
            false => usual,
            true => Self {
                accent: rgb(172, 73, 0),
                good: rgb(0, 110, 172),
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Least contrast of text [WCAG 2.2, level AA].
    const LEAST: f32 = 4.5;

    #[test]
    fn contrast_matches_known_values() {
        let grey = |level: u8| Color32::from_gray(level);
        assert!((contrast(Color32::WHITE, Color32::BLACK) - 21.0).abs() < 1e-4);
        assert_eq!(contrast(grey(90), grey(90)), 1.0);
        // #767676 is the lightest grey that WCAG allows for text on white; #777777 is too light.
        assert!((contrast(grey(0x76), Color32::WHITE) - 4.54).abs() < 0.005);
        assert!((contrast(Color32::WHITE, grey(0x77)) - 4.48).abs() < 0.005);
    }

    /// Colours of texts and signs, each with the grounds on which it is drawn. `named` explains the names.
    const PAIRS: [(&str, &[&str]); 6] = [
        ("ink", &["page", "paper", "card", "button", "chip", "title"]),
        ("faint", &["page", "paper", "card", "button"]),
        (
            "accent",
            &["page", "paper", "card", "button", "title", "frame"],
        ),
        ("good", &["page", "paper", "card", "button", "chip"]),
        ("on_accent", &["accent"]),
        ("card", &["ink"]),
    ];

    /// Margin of [`Theme::good`] on buttons above [`LEAST`], for small signs.
    const MARGIN: f32 = 0.1;

    fn named(theme: &Theme, name: &str) -> Color32 {
        let wall = colour(theme.world.floor[1]);
        match name {
            "page" => PAGE,
            "paper" => theme.paper,
            "card" => theme.card,
            "button" => theme.button,
            "ink" => theme.ink,
            "faint" => theme.faint,
            "accent" => theme.accent,
            "on_accent" => theme.on_accent,
            "good" => theme.good,
            // Labels and chips on translucent cards over the walls of a round.
            "chip" => wall.blend(theme.card.gamma_multiply(0.72)),
            // The page over the walls of a round, behind the title.
            "title" => dimmed(wall, DIMMED),
            // The pale ground of the title over the frame of a room.
            "frame" => {
                let frame = dimmed(colour(theme.world.frame), DIMMED);
                frame.blend(theme.card.gamma_multiply(0.8))
            }
            name => panic!("no colour {name:?}"),
        }
    }

    #[test]
    fn text_is_readable_on_every_ground() {
        for colour_safe in [false, true] {
            let theme = Theme::of(colour_safe);
            for (ink, grounds) in PAIRS {
                for &ground in grounds {
                    let found = contrast(named(&theme, ink), named(&theme, ground));
                    let least = match (ink, ground) {
                        ("good", "button") => LEAST + MARGIN,
                        _ => LEAST,
                    };
                    assert!(
                        found >= least,
                        "{ink} on {ground}: {found:.2}, colour_safe {colour_safe}"
                    );
                }
            }
        }
    }
}
