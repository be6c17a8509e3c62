//! Messages from a game to a synthesiser elsewhere, such as in an audio worklet. Entries in postcard's format
//! follow one another, so that the receiver reads them without allocating memory.

use crate::cue::Cue;
use crate::soundscape::{Soundscape, Volumes};
use crate::synth::Synth;
use serde::{Deserialize, Serialize};

/// Space in a message reserved for menu sounds and jingles [bytes]. These are few and must not be lost. A
/// thud, tear or crumb is dropped if it would leave less space.
const FOR_MENUS: usize = 512;

/// Space in a message reserved for soundscapes and volumes [bytes], several times the size of a soundscape. A
/// menu sound or jingle is dropped if it would leave less space.
const FOR_WHAT_LASTS: usize = 128;

/// Upper bound of the size of an entry [bytes].
const LONGEST: usize = 64;

/// Entry of a message. Sender and receiver must come from the same build.
#[derive(Deserialize, Serialize)]
enum Entry {
    Soundscape(Soundscape),
    Volumes(Volumes),
    Cue(Cue),
}

/// Calls of a [`Synth`] as bytes, collected over a frame.
#[derive(Default)]
pub struct Message(Vec<u8>);

impl Message {
    /// Maximum size of a message [bytes]. Entries that do not fit are dropped.
    pub const MOST_BYTES: usize = 4096;

    /// Records a call of [`Synth::set_soundscape`].
    pub fn hear(&mut self, soundscape: &Soundscape) {
        self.put(&Entry::Soundscape(*soundscape), 0);
    }

    /// Records a call of [`Synth::set_volumes`].
    pub fn set_volumes(&mut self, volumes: &Volumes) {
        self.put(&Entry::Volumes(*volumes), 0);
    }

    /// Records a call of [`Synth::play`].
    pub fn play(&mut self, cue: Cue) {
        let kept_free = match cue.is_of_world() {
            true => FOR_MENUS,
            false => FOR_WHAT_LASTS,
        };
        self.put(&Entry::Cue(cue), kept_free);
    }

    /// Returns the bytes for [`Synth::take`].
    pub fn bytes(&self) -> &[u8] {
        &self.0
    }

    /// Clears the message for the next frame.
    pub fn clear(&mut self) {
        self.0.clear();
    }

    fn put(&mut self, news: &Entry, kept_free: usize) {
        let mut longest = [0; LONGEST];
        let bytes =
            postcard::to_slice(news, &mut longest).expect("an entry fits into LONGEST bytes");
        if self.0.len() + bytes.len() + kept_free <= Self::MOST_BYTES {
            self.0.extend_from_slice(bytes);
        }
    }
}

impl Synth {
    /// Executes the calls of a [`Message`]. Ignores everything after the first invalid entry. Allocates
    /// nothing.
    pub fn take(&mut self, mut message: &[u8]) {
        while let Ok((news, rest)) = postcard::take_from_bytes(message) {
            match news {
                Entry::Soundscape(soundscape) => self.set_soundscape(&soundscape),
                Entry::Volumes(volumes) => self.set_volumes(&volumes),
                Entry::Cue(cue) => self.play(cue),
            }
            message = rest;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cue::{Menu, Route};
    use crate::soundscape::{Mute, Press};

    const PRESS: Press = Press {
        force: 600.0,
        slip: 0.5,
        x: -0.3,
    };

    const SOUNDSCAPE: Soundscape = Soundscape {
        presses: [PRESS, Press { x: 0.8, ..PRESS }],
        squash: 0.4,
        hold: 0.7,
        rewind: true,
        music: true,
        song: 3,
        hush: Mute::Nothing,
    };

    const VOLUMES: Volumes = Volumes {
        master: 0.9,
        effects: 0.7,
        music: 0.5,
        interface: 0.3,
    };

    const CUES: [Cue; 11] = [
        Cue::Thud {
            impulse: 30.0,
            x: -1.0,
        },
        Cue::Tear {
            energy: 10.0,
            x: 1.0,
        },
        Cue::Crumb { speed: 2.0, x: 0.0 },
        Cue::Snap { x: 0.5 },
        Cue::Switch {
            is_on: true,
            x: -0.5,
        },
        Cue::Won(Route::Squeeze),
        Cue::Won(Route::Shave),
        Cue::Won(Route::Mix),
        Cue::Menu(Menu::Move),
        Cue::Menu(Menu::Confirm),
        Cue::Menu(Menu::Back),
    ];

    fn everything() -> Message {
        let mut message = Message::default();
        message.hear(&SOUNDSCAPE);
        message.set_volumes(&VOLUMES);
        CUES.into_iter().for_each(|cue| message.play(cue));
        message
    }

    fn heard(mut synth: Synth) -> Vec<f32> {
        let mut samples = vec![0.0; 4000];
        synth.render(&mut samples);
        assert!(samples.iter().all(|sample| sample.abs() <= 1.0));
        samples
    }

    fn after(message: &[u8]) -> Vec<f32> {
        let mut synth = Synth::new(48_000);
        synth.take(message);
        heard(synth)
    }

    #[test]
    fn message_has_the_effect_of_the_calls() {
        let mut synth = Synth::new(48_000);
        synth.set_soundscape(&SOUNDSCAPE);
        synth.set_volumes(&VOLUMES);
        CUES.into_iter().for_each(|cue| synth.play(cue));
        assert_eq!(after(everything().bytes()), heard(synth));
    }

    #[test]
    fn message_round_trip_keeps_all_values() {
        let hushes = [Mute::Nothing, Mute::World, Mute::Everything];
        let mut message = Message::default();
        for hush in hushes {
            message.hear(&Soundscape { hush, ..SOUNDSCAPE });
        }
        let mut rest = message.bytes();
        for hush in hushes {
            let Ok((Entry::Soundscape(told), after)) = postcard::take_from_bytes(rest) else {
                panic!("no soundscape in {rest:?}");
            };
            assert_eq!(told, Soundscape { hush, ..SOUNDSCAPE });
            rest = after;
        }
        assert!(rest.is_empty());
        for cue in CUES {
            message.clear();
            message.play(cue);
            let told = postcard::from_bytes(message.bytes());
            assert!(
                matches!(told, Ok(Entry::Cue(told)) if told == cue),
                "{cue:?}"
            );
        }
    }

    #[test]
    fn truncated_message_keeps_its_complete_entries() {
        let message = everything();
        for length in 0..message.bytes().len() {
            after(&message.bytes()[..length]);
        }
        assert!(after(&message.bytes()[..3]).iter().all(|k| *k == 0.0));
        let mut more = message.bytes().to_vec();
        more.extend([255; 50]);
        assert_eq!(after(&more), after(message.bytes()));
    }

    #[test]
    fn synth_accepts_arbitrary_bytes() {
        let message = everything();
        for place in 0..message.bytes().len() {
            for byte in 0..=255 {
                let mut bytes = message.bytes().to_vec();
                bytes[place] = byte;
                let mut synth = Synth::new(8_000);
                synth.take(&bytes);
                let mut samples = [0.0; 64];
                synth.render(&mut samples);
                assert!(samples.iter().all(|sample| sample.abs() <= 1.0));
            }
        }
        for byte in 0..=255 {
            after(&[byte; Message::MOST_BYTES]);
        }
    }

    #[test]
    fn many_tears_leave_room_for_a_win_and_the_soundscape() {
        let mut flood = Message::default();
        let tear = CUES[1];
        (0..10_000).for_each(|_| flood.play(tear));
        let tears = flood.bytes().len();
        let win = Cue::Won(Route::Shave);
        (0..10_000).for_each(|_| flood.play(win));
        assert!(flood.bytes().len() > tears, "no space was left for a win");
        flood.hear(&SOUNDSCAPE);
        flood.set_volumes(&VOLUMES);
        assert!(flood.bytes().len() <= Message::MOST_BYTES);
        let last = flood.bytes().len() - 17;
        let told = postcard::from_bytes(&flood.bytes()[last..]);
        assert!(matches!(told, Ok(Entry::Volumes(told)) if told == VOLUMES));
    }
}
