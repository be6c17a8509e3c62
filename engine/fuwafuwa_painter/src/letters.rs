//! Stroke font, built in so that no font file is needed and all outputs look the same. It has the letters of
//! English, digits and some signs; other characters leave a gap.

use crate::PaperPoint;

/// Returns the strokes of a text as polylines. `at` is the top left corner of the text, `height` the height
/// of a capital letter.
pub fn lines(at: PaperPoint, height: f32, text: &str) -> Vec<Vec<PaperPoint>> {
    let unit = height / 6.0;
    let mut x = at[0];
    let mut lines = Vec::new();
    for letter in text.chars() {
        let (shift, _) = room(letter);
        for stroke in strokes(letter).split('|').filter(|s| !s.is_empty()) {
            let spot = |pair: &str| {
                let digit = |k: usize| f32::from(pair.as_bytes()[k] - b'0');
                [digit(0), digit(1)]
            };
            let spots: Vec<PaperPoint> = stroke.split(' ').map(spot).collect();
            let place = |[u, v]: PaperPoint| [x + (u - shift) * SLENDER * unit, at[1] + v * unit];
            lines.push(rounded(&spots).into_iter().map(place).collect());
        }
        x += advance(letter) * unit;
    }
    lines
}

/// Returns the width of a text [px].
pub fn width(height: f32, text: &str) -> f32 {
    text.chars().map(advance).sum::<f32>() * height / 6.0
}

/// Width of a grid column of the letters, relative to the height of a grid row.
const SLENDER: f32 = 0.78;

fn advance(letter: char) -> f32 {
    let (shift, width) = room(letter);
    debug_assert!(shift >= 0.0);
    width * SLENDER + 1.3
}

/// Returns the number of empty grid columns to the left of a letter, and the number of columns that the
/// letter fills.
fn room(letter: char) -> (f32, f32) {
    match letter {
        'i' | '.' | ',' | ':' | '!' | '\'' | '|' => (2.0, 0.4),
        'l' | '(' | ')' | 'I' => (1.0, 2.0),
        'j' => (1.0, 1.4),
        't' | 'f' | 'r' => (0.5, 3.0),
        ' ' => (0.0, 2.4),
        _ => (0.0, 4.0),
    }
}

/// Rounds the corners of a stroke, except sharp corners and right angles between axis-parallel lines.
fn rounded(spots: &[PaperPoint]) -> Vec<PaperPoint> {
    let mut curve = Vec::new();
    let closed = spots.len() > 2 && spots.first() == spots.last();
    let count = spots.len();
    for (k, &spot) in spots.iter().enumerate() {
        let before = match k {
            0 if closed => Some(spots[count - 2]),
            0 => None,
            _ => Some(spots[k - 1]),
        };
        let after = match k {
            k if k + 1 == count && closed => Some(spots[1]),
            k => spots.get(k + 1).copied(),
        };
        match (before, after) {
            (Some(before), Some(after)) if is_round(before, spot, after) => {
                let (from, to) = (middle(before, spot), middle(spot, after));
                curve.extend(
                    (0..=4).map(|step| quadratic_bezier(from, spot, to, step as f32 / 4.0)),
                );
            }
            _ => curve.push(spot),
        }
    }
    curve
}

fn is_round(before: PaperPoint, at: PaperPoint, after: PaperPoint) -> bool {
    let (u, v) = (minus(at, before), minus(after, at));
    let length = |w: PaperPoint| (w[0] * w[0] + w[1] * w[1]).sqrt();
    let cosine = (u[0] * v[0] + u[1] * v[1]) / (length(u) * length(v)).max(1e-6);
    let slanted = |w: PaperPoint| w[0] != 0.0 && w[1] != 0.0;
    cosine > 0.69 || (cosine > -0.01 && slanted(u) && slanted(v))
}

/// Evaluates a quadratic Bézier curve at `t`.
fn quadratic_bezier(from: PaperPoint, by: PaperPoint, to: PaperPoint, t: f32) -> PaperPoint {
    let s = 1.0 - t;
    [0, 1].map(|k: usize| s * s * from[k] + 2.0 * s * t * by[k] + t * t * to[k])
}

fn middle(a: PaperPoint, b: PaperPoint) -> PaperPoint {
    [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]
}

fn minus(a: PaperPoint, b: PaperPoint) -> PaperPoint {
    [a[0] - b[0], a[1] - b[1]]
}

/// Returns the strokes of a letter on a grid of 4 × 8: each pair of digits is a point x, y, and `|` begins a
/// new stroke.
fn strokes(letter: char) -> &'static str {
    match letter {
        '0' => "10 30 41 45 36 16 05 01 10",
        '1' => "11 20 26|16 36",
        '2' => "01 10 30 41 42 06 46",
        '3' => "01 10 30 41 42 33 13|33 44 45 36 16 05",
        '4' => "36 30 04 44",
        '5' => "40 00 03 33 44 45 36 16 05",
        '6' => "30 10 01 05 16 36 45 44 33 13 04",
        '7' => "00 40 16",
        '8' => "13 02 01 10 30 41 42 33 13 04 05 16 36 45 44 33",
        '9' => "16 36 45 41 30 10 01 02 13 33 42",
        'a' => "12 32 43 46|44 14 05 16 36 45",
        'b' => "00 06|03 12 32 43 45 36 16 05",
        'c' => "43 32 12 03 05 16 36 45",
        'd' => "40 46|43 32 12 03 05 16 36 45",
        'e' => "04 44 43 32 12 03 05 16 36 45",
        'f' => "40 30 21 26|12 42",
        'g' => "42 47 38 18|43 32 12 03 05 16 36 45",
        'h' => "00 06|03 12 32 43 46",
        'i' => "22 26|20 20",
        'j' => "22 27 18|20 20",
        'k' => "00 06|42 04|13 46",
        'l' => "20 25 36",
        'm' => "02 06|03 12 23 26|23 32 43 46",
        'n' => "02 06|03 12 32 43 46",
        'o' => "12 32 43 45 36 16 05 03 12",
        'p' => "02 08|03 12 32 43 45 36 16 05",
        'q' => "42 48|43 32 12 03 05 16 36 45",
        'r' => "12 16|14 32 42",
        's' => "43 32 12 03 14 34 45 36 16 05",
        't' => "20 25 36 46|12 42",
        'u' => "02 05 16 36 45|42 46",
        'v' => "02 26 42",
        'w' => "02 16 24 36 42",
        'x' => "02 46|42 06",
        'y' => "02 05 16 36 45|42 47 38 18",
        'z' => "02 42 06 46",
        'A' => "06 20 46|14 34",
        'B' => "00 06 36 45 44 33 42 41 30 00|03 33",
        'C' => "41 30 10 01 05 16 36 45",
        'D' => "00 06 26 45 41 20 00",
        'E' => "40 00 06 46|03 33",
        'F' => "40 00 06|03 33",
        'G' => "41 30 10 01 05 16 36 45 43 23",
        'H' => "00 06|40 46|03 43",
        'I' => "20 26",
        'J' => "40 45 36 16 05",
        'K' => "00 06|40 03 46",
        'L' => "00 06 46",
        'M' => "06 00 23 40 46",
        'N' => "06 00 46 40",
        'O' | '°' => "10 30 41 45 36 16 05 01 10",
        'P' => "06 00 30 41 42 33 03",
        'Q' => "10 30 41 45 36 16 05 01 10|24 46",
        'R' => "06 00 30 41 42 33 03|23 46",
        'S' => "41 30 10 01 02 13 33 44 45 36 16 05",
        'T' => "00 40|20 26",
        'U' => "00 05 16 36 45 40",
        'V' => "00 26 40",
        'W' => "00 16 22 36 40",
        'X' => "00 46|40 06",
        'Y' => "00 23 40|23 26",
        'Z' => "00 40 06 46",
        '.' => "26 26",
        '!' => "20 24|26 26",
        '?' => "01 10 30 41 42 24|26 26",
        ',' => "26 17",
        ':' => "22 22|26 26",
        '\'' => "20 21",
        '|' => "20 27",
        '-' => "14 34",
        '+' => "04 44|22 26",
        '=' => "03 43|05 45",
        '<' => "42 04 46",
        '>' => "02 44 06",
        '/' => "40 06",
        '(' => "30 21 15 26 37",
        ')' => "10 21 25 17",
        '%' => "40 06|01 01|45 45",
        _ => "",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strokes_lie_on_grid() {
        for letter in ' '..='~' {
            for pair in strokes(letter).split(['|', ' ']).filter(|s| !s.is_empty()) {
                let digits = pair.as_bytes();
                assert_eq!(digits.len(), 2, "{letter}: {pair}");
                assert!((b'0'..=b'4').contains(&digits[0]), "{letter}: {pair}");
                assert!((b'0'..=b'8').contains(&digits[1]), "{letter}: {pair}");
            }
        }
    }

    #[test]
    fn width_matches_lines() {
        let text = "level 0, 2.5 s";
        let right = lines([0.0; 2], 6.0, text).into_iter().flatten();
        let right = right.map(|spot| spot[0]).fold(0.0, f32::max);
        assert!(right < width(6.0, text) && right > 0.9 * width(6.0, text));
    }
}
