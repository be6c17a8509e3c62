//! QR codes of links, which are opened on a phone.

use qrcode::{Color, EcLevel, QrCode};
use tamaire_play::link::address;
use tamaire_play::{Level, Replay};

/// A QR code.
#[derive(Clone, Debug, PartialEq)]
pub struct Code {
    /// The encoded address.
    pub address: String,
    /// Number of modules on a side.
    pub side: usize,
    /// Modules row by row from the upper left corner; true = dark.
    pub dark: Vec<bool>,
}

impl Code {
    /// Creates the code of the address at which `page` shows a round. `None` if the address is too long for a
    /// QR code.
    pub fn of_round(page: &str, replay: &Replay) -> Option<Self> {
        Self::of_address(address(page, &replay.code().ok()?))
    }

    /// Creates the code of the address at which `page` opens a level. `None` if the address is too long for a QR
    /// code.
    pub fn of_level(page: &str, level: &Level) -> Option<Self> {
        Self::of_address(address(page, &level.code().ok()?))
    }

    fn of_address(address: String) -> Option<Self> {
        // A code on a screen cannot be stained, so the lowest level of error correction is enough.
        let code = QrCode::with_error_correction_level(&address, EcLevel::L).ok()?;
        let dark = code.to_colors().into_iter();
        Some(Self {
            address,
            side: code.width(),
            dark: dark.map(|module| module == Color::Dark).collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;
    use tamaire_play::{AnyRound, Bot, BotKind, Level, Link};

    fn played(seconds: usize) -> Replay {
        let mut round = AnyRound::new(Arc::new(Level::open("classic").unwrap()));
        round.play(&mut Bot::new(BotKind::Squeeze, 3), 60 * seconds);
        round.replay()
    }

    #[test]
    fn code_decodes_to_played_round() {
        const PIXELS: usize = 4;
        const QUIET: usize = 4;
        let replay = played(60);
        assert!(replay.outcome.is_some());
        let code = Code::of_round("https://example.org/tamaire/", &replay).unwrap();
        let side = PIXELS * (code.side + 2 * QUIET);
        let mut image = rqrr::PreparedImage::prepare_from_greyscale(side, side, |x, y| {
            let [x, y] = [x, y].map(|pixel| (pixel / PIXELS).wrapping_sub(QUIET));
            let is_dark = x < code.side && y < code.side && code.dark[y * code.side + x];
            if is_dark { 0 } else { 255 }
        });
        let (_, read) = image.detect_grids()[0].decode().unwrap();
        assert_eq!(read, code.address);
        let Ok(Link::Round(round)) = Link::read(&read) else {
            panic!("{read}");
        };
        assert_eq!(
            (round.ticks(), round.outcome),
            (replay.ticks(), replay.outcome)
        );
    }

    #[test]
    fn code_is_none_for_too_long_address() {
        let page = format!("https://example.org/{}", "x".repeat(3000));
        assert!(Code::of_round(&page, &played(1)).is_none());
    }
}
