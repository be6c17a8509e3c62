//! Playback on the sound device.
//!
//! Three threads share a mailbox. The game writes sounds into the mailbox. The device thread reads them;
//! while the game is writing, it continues with the sounds that it read before. A keeper thread opens the
//! device and retries until it succeeds.

mod device;
mod mailbox;
mod source;

use crate::cue::Cue;
use crate::soundscape::{Soundscape, Volumes};
use device::{PATIENCE, keep_open, open_stream};
pub use mailbox::SoundError;
use mailbox::{Mailbox, lock};
use std::sync::mpsc;
use std::sync::{Arc, Mutex};
use std::thread;

/// Connection to the sound device. Dropping it ends the sound.
pub struct Speaker {
    mailbox: Arc<Mutex<Mailbox>>,
}

impl Speaker {
    /// Opens the default device, which takes at most three seconds. While there is no device,
    /// [`Speaker::trouble`] gives the reason, and opening is retried.
    ///
    /// # Errors
    /// [`SoundError`] if no thread can be started.
    pub fn open() -> Result<Self, SoundError> {
        let mailbox = Arc::new(Mutex::new(Mailbox {
            trouble: Some(SoundError::NoAnswer),
            ..Mailbox::new()
        }));
        let (opened, answer) = mpsc::channel();
        let keeper = Arc::downgrade(&mailbox);
        thread::Builder::new()
            .name("sound".to_owned())
            .spawn(move || keep_open(&keeper, opened, |lost| open_stream(&keeper, lost)))
            .map_err(|error| SoundError::Refused(error.to_string()))?;
        // Ignores the answer: success or failure is recorded in the mailbox.
        let _ = answer.recv_timeout(PATIENCE);
        Ok(Self { mailbox })
    }

    /// Sets the continuous sounds and the volumes. To be called in every frame.
    pub fn update(&self, soundscape: &Soundscape, volumes: &Volumes) {
        let mut mailbox = lock(&self.mailbox);
        mailbox.soundscape = *soundscape;
        mailbox.volumes = *volumes;
        mailbox.number += 1;
    }

    /// Starts a momentary sound.
    pub fn play(&self, cue: Cue) {
        lock(&self.mailbox).put(cue);
    }

    /// Returns the reason why no sound plays, such as an unplugged device; `None` if sound plays. Opening the
    /// device is retried every few seconds.
    pub fn trouble(&self) -> Option<SoundError> {
        lock(&self.mailbox).trouble.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::device::{PAUSE, report};
    use super::mailbox::MOST_CUES_OF_THE_WORLD;
    use super::source::Source;
    use super::*;
    use crate::cue::{Menu, Route};
    use crate::soundscape::Press;
    use std::time::{Duration, Instant};

    fn speaker() -> (Speaker, Source) {
        let mailbox = Arc::new(Mutex::new(Mailbox::new()));
        let source = Source::new(Arc::downgrade(&mailbox), 48_000);
        (Speaker { mailbox }, source)
    }

    fn loudest(source: &mut Source) -> f32 {
        let mut out = [0.0_f32; 2 * 1000];
        source.fill(&mut out, 2);
        out.iter().fold(0.0, |most, k| most.max(k.abs()))
    }

    #[test]
    fn updates_and_cues_are_heard_in_the_next_block() {
        let (speaker, mut source) = speaker();
        assert_eq!(loudest(&mut source), 0.0);
        let press = Press {
            force: 800.0,
            slip: 1.0,
            x: 0.0,
        };
        let soundscape = Soundscape {
            presses: [press; 2],
            ..Soundscape::default()
        };
        speaker.update(&soundscape, &Volumes::default());
        assert!(loudest(&mut source) > 0.0);
        let (speaker, mut source) = self::speaker();
        speaker.play(Cue::Menu(Menu::Confirm));
        assert!(loudest(&mut source) > 0.01);
    }

    #[test]
    fn locked_mailbox_does_not_block_the_device() {
        let (speaker, mut source) = speaker();
        speaker.play(Cue::Menu(Menu::Confirm));
        let writing = speaker.mailbox.lock().expect("the mailbox is not poisoned");
        assert_eq!(loudest(&mut source), 0.0);
        drop(writing);
        assert!(loudest(&mut source) > 0.01);
    }

    #[test]
    fn many_tears_leave_room_for_a_win() {
        let (speaker, source) = speaker();
        for _ in 0..10_000 {
            speaker.play(Cue::Tear {
                energy: 1.0,
                x: 0.0,
            });
        }
        speaker.play(Cue::Won(Route::Shave));
        let mailbox = lock(&speaker.mailbox);
        assert_eq!(mailbox.cues.len(), MOST_CUES_OF_THE_WORLD + 1);
        assert_eq!(mailbox.cues.last(), Some(&Cue::Won(Route::Shave)));
        drop(source);
    }

    #[test]
    fn cues_without_a_device_are_discarded() {
        let (speaker, mut source) = speaker();
        let weak = Arc::downgrade(&speaker.mailbox);
        speaker.play(Cue::Won(Route::Shave));
        report(&weak, Some(SoundError::NoDevice));
        assert_eq!(speaker.trouble(), Some(SoundError::NoDevice));
        speaker.play(Cue::Won(Route::Shave));
        report(&weak, None);
        assert_eq!((speaker.trouble(), loudest(&mut source)), (None, 0.0));
    }

    #[test]
    fn device_plugged_in_later_is_opened() {
        let (speaker, _) = speaker();
        let weak = Arc::downgrade(&speaker.mailbox);
        let (opened, answer) = mpsc::channel();
        let (plug, socket) = mpsc::channel();
        let keeper = thread::spawn(move || {
            keep_open(&weak, opened, |lost| {
                socket.try_recv().map_err(|_| SoundError::NoDevice)?;
                Ok::<_, SoundError>(lost)
            });
        });
        assert!(answer.recv().is_err(), "the first attempt has not ended");
        assert_eq!(speaker.trouble(), Some(SoundError::NoDevice));
        plug.send(()).unwrap();
        let patience = Instant::now() + 5 * PAUSE;
        while speaker.trouble().is_some() && Instant::now() < patience {
            thread::sleep(Duration::from_millis(50));
        }
        assert_eq!(speaker.trouble(), None);
        drop(speaker);
        keeper.join().unwrap();
    }

    #[test]
    fn speaker_falls_silent_when_dropped() {
        let (speaker, mut source) = speaker();
        speaker.play(Cue::Won(Route::Squeeze));
        assert!(loudest(&mut source) > 0.01);
        drop(speaker);
        for _ in 0..12 {
            loudest(&mut source);
        }
        assert_eq!(loudest(&mut source), 0.0);
    }

    #[test]
    fn source_fills_any_number_of_channels() {
        for channels in [1, 2, 6] {
            let (speaker, mut source) = speaker();
            speaker.play(Cue::Menu(Menu::Confirm));
            let mut out = vec![7_u8; 600 * channels];
            source.fill(&mut out, channels);
            for channel in 0..channels {
                let mut samples = out.iter().skip(channel).step_by(channels);
                assert_eq!(
                    samples.any(|sample| *sample != 128),
                    channel < 2,
                    "{channel} of {channels}"
                );
            }
        }
    }
}
