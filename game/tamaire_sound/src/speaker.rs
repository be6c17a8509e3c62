//! Plays on the machine's sound device.
//!
//! Three threads meet at a mailbox: the game leaves there what is to be heard; the device's own
//! thread takes it, and goes on with what it has while the game is just writing; a keeper opens the
//! device, and goes on trying while there is none.

mod device;
mod mailbox;
mod source;

use crate::cue::Cue;
use crate::soundscape::{Soundscape, Volumes};
use device::{PATIENCE, keep_open, open_stream};
pub use mailbox::NoSound;
use mailbox::{Mailbox, lock};
use std::sync::mpsc;
use std::sync::{Arc, Mutex};
use std::thread;

/// The machine's sound device. Falls silent when dropped.
pub struct Speaker {
    mailbox: Arc<Mutex<Mailbox>>,
}

impl Speaker {
    /// Opens the device that the system prefers. It may take a moment, at most three seconds. While
    /// there is none, [`Speaker::trouble`] says so, and it is looked for again and again.
    ///
    /// # Errors
    /// [`NoSound`] when there is no thread to be had for it.
    pub fn open() -> Result<Self, NoSound> {
        let mailbox = Arc::new(Mutex::new(Mailbox {
            trouble: Some(NoSound::NoAnswer),
            ..Mailbox::new()
        }));
        let (opened, answer) = mpsc::channel();
        let keeper = Arc::downgrade(&mailbox);
        thread::Builder::new()
            .name("sound".to_owned())
            .spawn(move || keep_open(&keeper, opened, |lost| open_stream(&keeper, lost)))
            .map_err(|error| NoSound::Refused(error.to_string()))?;
        // Whatever became of it stands in the mailbox.
        let _ = answer.recv_timeout(PATIENCE);
        Ok(Self { mailbox })
    }

    /// Tells what lasts and how loud it is to be. To be called each frame.
    pub fn update(&self, soundscape: &Soundscape, volumes: &Volumes) {
        let mut mailbox = lock(&self.mailbox);
        mailbox.soundscape = *soundscape;
        mailbox.volumes = *volumes;
        mailbox.number += 1;
    }

    /// Begins what sounds once.
    pub fn play(&self, cue: Cue) {
        lock(&self.mailbox).put(cue);
    }

    /// Why nothing is heard just now, if so: the device was unplugged, say. It is looked for again
    /// every few seconds.
    pub fn trouble(&self) -> Option<NoSound> {
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
    fn what_the_game_tells_is_heard_in_the_next_block() {
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
    fn a_game_that_is_writing_does_not_hold_up_the_device() {
        let (speaker, mut source) = speaker();
        speaker.play(Cue::Menu(Menu::Confirm));
        let writing = speaker.mailbox.lock().expect("nobody panicked");
        assert_eq!(loudest(&mut source), 0.0);
        drop(writing);
        assert!(loudest(&mut source) > 0.01);
    }

    #[test]
    fn a_flood_of_tears_leaves_room_for_the_win() {
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
    fn cues_of_a_time_without_device_are_not_heard_later() {
        let (speaker, mut source) = speaker();
        let weak = Arc::downgrade(&speaker.mailbox);
        speaker.play(Cue::Won(Route::Shave));
        report(&weak, Some(NoSound::NoDevice));
        assert_eq!(speaker.trouble(), Some(NoSound::NoDevice));
        speaker.play(Cue::Won(Route::Shave));
        report(&weak, None);
        assert_eq!((speaker.trouble(), loudest(&mut source)), (None, 0.0));
    }

    #[test]
    fn a_device_that_comes_later_is_found() {
        let (speaker, _) = speaker();
        let weak = Arc::downgrade(&speaker.mailbox);
        let (opened, answer) = mpsc::channel();
        let (plug, socket) = mpsc::channel();
        let keeper = thread::spawn(move || {
            keep_open(&weak, opened, |lost| {
                socket.try_recv().map_err(|_| NoSound::NoDevice)?;
                Ok::<_, NoSound>(lost)
            });
        });
        assert!(answer.recv().is_err(), "the first attempt is over");
        assert_eq!(speaker.trouble(), Some(NoSound::NoDevice));
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
    fn it_falls_silent_when_dropped() {
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
    fn any_number_of_channels_is_filled() {
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
