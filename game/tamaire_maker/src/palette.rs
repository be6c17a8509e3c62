//! Crayons: materials that a drawing names by number.

use fuwafuwa_scenes::scene::MaterialText;
use tamaire_play::playground::Stuff;

/// Maximum number of crayons: the number of a crayon is a byte, and 0 means empty.
const MOST: usize = u8::MAX as usize;

/// Materials of a drawing. The crayons come first, in the order of [`Stuff::ALL`]; the other materials of a body that was
/// brought to the paper follow.
#[derive(Clone, Debug, PartialEq)]
pub struct Palette(Vec<MaterialText>);

impl Default for Palette {
    fn default() -> Self {
        Self(Stuff::ALL.map(crayon).into())
    }
}

/// Returns the material of a crayon with its colour. Jelly and biscuits are tougher than in a playground, because drawings
/// have thin legs and tails that must withstand a fall.
pub fn crayon(stuff: Stuff) -> MaterialText {
    let colour = match stuff {
        Stuff::Jelly => [240, 110, 130],
        Stuff::Rubber => [90, 165, 220],
        Stuff::Biscuit => [232, 186, 110],
        Stuff::Clay => [150, 175, 110],
        Stuff::Stone => [140, 140, 150],
        Stuff::Caramel => [176, 96, 44],
    };
    let material = stuff.material();
    let [strength, toughness] = match stuff {
        Stuff::Jelly => [Some(4000.0), Some(500.0)],
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

    /// Returns the number of a material, and adds the material if it is new. A palette that is full returns the number
    /// of its last material.
    pub fn number_of(&mut self, material: &MaterialText) -> u8 {
        number_in(&mut self.0, material, MOST)
    }
}

/// Returns the number of `material` in a list, counted from 1, and adds the material if it is new. A list of `most`
/// materials takes no further one; then the last number is returned.
pub fn number_in(list: &mut Vec<MaterialText>, material: &MaterialText, most: usize) -> u8 {
    let known = list.iter().position(|known| known == material);
    let place = known.unwrap_or_else(|| {
        if list.len() < most {
            list.push(material.clone());
        }
        list.len().saturating_sub(1)
    });
    (place + 1).min(MOST) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn palette_numbers_crayons_as_the_playground_does() {
        let mut palette = Palette::default();
        for stuff in Stuff::ALL {
            assert_eq!(palette.number_of(&crayon(stuff)), stuff.number());
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
            let material = MaterialText {
                young: Some(f64::from(young)),
                ..MaterialText::default()
            };
            assert!(palette.number_of(&material) > 0);
        }
        assert_eq!(palette.materials().len(), MOST);
    }
}
