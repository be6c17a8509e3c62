//! Colours of everything that is drawn.

/// Red, green and blue (sRGB), 0 to 1.
pub type Colour = [f32; 3];

/// Returns the colour of a hexadecimal number, as in `rgb(0xff8a70)`.
pub const fn rgb(hex: u32) -> Colour {
    [
        (hex >> 16 & 255) as f32 / 255.0,
        (hex >> 8 & 255) as f32 / 255.0,
        (hex & 255) as f32 / 255.0,
    ]
}

/// Colours of everything that is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Palette {
    /// Floor of the arena: centre and rim.
    pub floor: [Colour; 2],
    /// Frame around the arena (half-spaces).
    pub frame: Colour,
    /// Bounded fixed and dynamic rigid bodies such as bars, boxes and pegs.
    pub bar: Colour,
    /// Rigid bodies that let bodies with the default layers through, such as fences for hands.
    pub glass: Colour,
    /// Rigid bodies that let hands through and stop bodies.
    pub curtain: Colour,
    /// Glow of the basket.
    pub basket: Colour,
    /// Colours of bodies by material number, starting at number 1. The list repeats after its end.
    pub materials: Vec<Colour>,
    /// Inside of a body. Torn surfaces mix this colour with the colour of the body.
    pub fresh: Colour,
    /// Colours of hands by player. The list repeats after its end.
    pub hands: Vec<Colour>,
    /// Colours of elements by level, starting at 0. The last colour is used for all higher levels.
    pub levels: Vec<Colour>,
    /// Colours of elements by strain: none, medium, high.
    pub strains: [Colour; 3],
    /// Lines between elements.
    pub ink: Colour,
}

impl Palette {
    /// Returns the default palette: warm bodies on a cool floor.
    pub fn candy() -> Self {
        Self {
            floor: [rgb(0xf3f6ee), rgb(0xcfe6e4)],
            frame: rgb(0x7fb7b4),
            bar: rgb(0xe6b877),
            glass: rgb(0x7fb2d6),
            curtain: rgb(0x5a6ca6),
            basket: rgb(0xffbe3d),
            materials: [
                0xff8d78, 0x9c4f93, 0xffb84d, 0x8fc46a, 0x6aa9d8, 0xd98fd0, 0xc49a6c, 0xf2e3c9,
            ]
            .map(rgb)
            .to_vec(),
            fresh: rgb(0xffcfd0),
            hands: [0x3f7fe0, 0x35a877].map(rgb).to_vec(),
            levels: [0xf7e7a1, 0x8fd3c1, 0x5a9bd4, 0x5b5aa6, 0x3b2f63]
                .map(rgb)
                .to_vec(),
            strains: [0x2c4875, 0xbc5090, 0xffc857].map(rgb),
            ink: rgb(0x3a2b3f),
        }
    }

    /// Returns colours that colour-blind people can tell apart, also by lightness [Okabe 2008].
    pub fn colour_safe() -> Self {
        Self {
            floor: [rgb(0xf7f7f5), rgb(0xdde3e8)],
            frame: rgb(0x66788a),
            bar: rgb(0xb9b2a3),
            glass: rgb(0x7fb2d6),
            curtain: rgb(0x5a6ca6),
            basket: rgb(0xf0e442),
            materials: [
                0xe69f00, 0x7a3b00, 0xcc79a7, 0x009e73, 0x56b4e9, 0xd55e00, 0x999999, 0xf0e442,
            ]
            .map(rgb)
            .to_vec(),
            fresh: rgb(0xfff3d6),
            hands: [0x0072b2, 0x2b2b2b].map(rgb).to_vec(),
            levels: [0xfde725, 0x6ccd5a, 0x2a9d8f, 0x3b528b, 0x440154]
                .map(rgb)
                .to_vec(),
            strains: [0x00224e, 0x7d7c78, 0xfee838].map(rgb),
            ink: rgb(0x1b1b1b),
        }
    }

    /// Returns the colour of a material number.
    pub fn material(&self, number: u8) -> Colour {
        among(&self.materials, usize::from(number.max(1)) - 1)
    }

    /// Returns the colour of a material number: that of the scene if `own` has one, number 1 first, otherwise that
    /// of the palette. Scenes give red, green and blue, 0 to 255 (sRGB).
    pub fn tinted_material(&self, number: u8, own: &[Option<[u8; 3]>]) -> Colour {
        match own.get(usize::from(number).wrapping_sub(1)) {
            Some(Some(colour)) => colour.map(|channel| f32::from(channel) / 255.0),
            _ => self.material(number),
        }
    }

    /// Returns the colour of a player's hand.
    pub fn hand(&self, player: usize) -> Colour {
        among(&self.hands, player)
    }

    /// Returns the colour of a level.
    pub fn level(&self, level: u8) -> Colour {
        let last = self.levels.len().saturating_sub(1);
        among(&self.levels, usize::from(level).min(last))
    }

    /// Returns the colour of a strain ‖F − R‖. Strains of 0.5 and more have the colour of high strain.
    pub fn strain(&self, strain: f32) -> Colour {
        let [none, some, much] = self.strains;
        let share = (2.0 * strain).clamp(0.0, 1.0);
        match share < 0.5 {
            true => mix(none, some, 2.0 * share),
            false => mix(some, much, 2.0 * share - 1.0),
        }
    }
}

impl Default for Palette {
    fn default() -> Self {
        Self::candy()
    }
}

/// Interpolates linearly between two colours.
pub(crate) fn mix(a: Colour, b: Colour, share: f32) -> Colour {
    [0, 1, 2].map(|k| a[k] + (b[k] - a[k]) * share)
}

/// Converts a colour and an opacity to four bytes.
pub(crate) fn bytes(colour: Colour, alpha: f32) -> [u8; 4] {
    let byte = |k: f32| (k.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
    let [red, green, blue] = colour.map(byte);
    [red, green, blue, byte(alpha)]
}

/// Returns the colour at an index of a list that repeats after its end; grey if the list is empty.
pub(crate) fn among(colours: &[Colour], place: usize) -> Colour {
    let some = colours.get(place % colours.len().max(1));
    some.copied().unwrap_or([0.5; 3])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_repeat_but_levels_saturate() {
        let palette = Palette::candy();
        assert_eq!(palette.hand(0), palette.hand(2));
        assert_ne!(palette.hand(0), palette.hand(1));
        assert_eq!(palette.level(200), palette.levels[4]);
        assert_eq!(palette.strain(0.0), palette.strains[0]);
        assert_eq!(palette.strain(9.0), palette.strains[2]);
        assert_eq!(bytes(rgb(0xff8000), 1.0), [255, 128, 0, 255]);
    }

    #[test]
    fn colour_safe_levels_differ_in_lightness() {
        let palette = Palette::colour_safe();
        let lightness = |c: Colour| 0.3 * c[0] + 0.59 * c[1] + 0.11 * c[2];
        for pair in palette.levels.windows(2) {
            assert!(lightness(pair[0]) > lightness(pair[1]) + 0.08, "{pair:?}");
        }
    }
}
