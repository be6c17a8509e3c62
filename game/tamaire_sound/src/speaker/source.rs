//! Source of the samples that the sound device plays.

use super::mailbox::Mailbox;
use crate::soundscape::{Mute, Soundscape};
use crate::synth::Synth;
use cpal::{FromSample, SizedSample};
use std::sync::{Mutex, TryLockError, Weak};

/// Maximum number of frames (left and right sample) rendered at a time.
const FRAMES: usize = 256;

/// State of the device thread, which must never block or allocate.
pub struct Source {
    mailbox: Weak<Mutex<Mailbox>>,
    synth: Synth,
    /// Number of the update that was read last from the mailbox.
    number: u64,
}

impl Source {
    pub fn new(mailbox: Weak<Mutex<Mailbox>>, rate: u32) -> Self {
        Self {
            mailbox,
            synth: Synth::new(rate),
            number: 0,
        }
    }

    /// Fills `out` with frames of `channels` samples. A single channel gets the mean of left and right;
    /// channels after the second are silent.
    pub fn fill<T: SizedSample + FromSample<f32>>(&mut self, out: &mut [T], channels: usize) {
        self.listen();
        let mut stereo = [0.0; 2 * FRAMES];
        for part in out.chunks_mut(FRAMES * channels) {
            let stereo = &mut stereo[..2 * part.len().div_ceil(channels)];
            self.synth.render(stereo);
            for (frame, sides) in part.chunks_mut(channels).zip(stereo.chunks(2)) {
                if let [one] = frame {
                    *one = T::from_sample(0.5 * (sides[0] + sides[1]));
                    continue;
                }
                frame.fill(T::EQUILIBRIUM);
                for (sample, side) in frame.iter_mut().zip(sides) {
                    *sample = T::from_sample(*side);
                }
            }
        }
    }

    /// Reads updates and cues from the mailbox. If the mailbox is locked, leaves them for the next call.
    fn listen(&mut self) {
        let Some(mailbox) = self.mailbox.upgrade() else {
            let hush = Mute::Everything;
            self.synth.set_soundscape(&Soundscape {
                hush,
                ..Soundscape::default()
            });
            return;
        };
        let mut mailbox = match mailbox.try_lock() {
            Ok(mailbox) => mailbox,
            Err(TryLockError::Poisoned(poisoned)) => poisoned.into_inner(),
            Err(TryLockError::WouldBlock) => return,
        };
        if self.number != mailbox.number {
            self.number = mailbox.number;
            self.synth.set_soundscape(&mailbox.soundscape);
            self.synth.set_volumes(&mailbox.volumes);
        }
        for cue in mailbox.cues.drain(..) {
            self.synth.play(cue);
        }
    }
}
