//! Colours of palette indices.

/// Red, green and blue, palette index 1 first. The last entry belongs to no index.
pub(super) type Palette = [[u8; 3]; 256];

/// Palette of a file without colours: MagicaVoxel's default. It has the colours with channels of 255, 204,
/// 153, 102, 51 and 0 except black, and ramps of ten shades of red, green, blue and grey.
pub(super) const DEFAULT: Palette = default();

const fn default() -> Palette {
    const STEPS: [u8; 6] = [255, 204, 153, 102, 51, 0];
    const SHADES: [u8; 10] = [238, 221, 187, 170, 136, 119, 85, 68, 34, 17];
    let mut palette = [[0; 3]; 256];
    let mut at = 0;
    while at < 215 {
        palette[at] = [STEPS[at / 36], STEPS[at / 6 % 6], STEPS[at % 6]];
        at += 1;
    }
    let mut step = 0;
    while step < SHADES.len() {
        let shade = SHADES[step];
        palette[215 + step] = [shade, 0, 0];
        palette[225 + step] = [0, shade, 0];
        palette[235 + step] = [0, 0, shade];
        palette[245 + step] = [shade; 3];
        step += 1;
    }
    palette
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The expected colours are copied from the table in MagicaVoxel-file-format-vox.txt, as 0xBBGGRR.
    #[test]
    fn default_palette_matches_the_documentation_of_the_format() {
        for (index, colour) in [
            (1, 0xffffff),
            (2, 0xccffff),
            (7, 0xffccff),
            (16, 0x6699ff),
            (37, 0xffffcc),
            (79, 0xffcc99),
            (215, 0x330000),
            (216, 0x0000ee),
            (225, 0x000011),
            (226, 0x00ee00),
            (236, 0xee0000),
            (245, 0x110000),
            (246, 0xeeeeee),
            (255, 0x111111),
        ] {
            let [red, green, blue] = DEFAULT[index - 1].map(u32::from);
            assert_eq!(
                red | green << 8 | blue << 16,
                colour,
                "palette index {index}"
            );
        }
    }
}
