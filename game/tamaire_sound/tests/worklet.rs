//! Compares the worklet with a synthesiser, and checks that the audio thread never allocates memory.

mod shared;

use shared::TAKEN;
use tamaire_sound::worklet::{MOST_FRAMES, Worklet};
use tamaire_sound::{Cue, Menu, Message, Press, Soundscape, Synth};

const SOUNDSCAPE: Soundscape = Soundscape {
    presses: [Press {
        force: 500.0,
        slip: 0.5,
        x: 0.0,
    }; 2],
    squash: 0.3,
    hold: 0.7,
    rewind: false,
    music: true,
    song: 0,
    hush: tamaire_sound::Mute::Nothing,
};

fn tell(worklet: &mut Worklet, message: &[u8]) {
    worklet.message()[..message.len()].copy_from_slice(message);
    worklet.take(message.len());
}

fn loudest(samples: &[f32]) -> f32 {
    samples
        .iter()
        .fold(0.0, |most, sample| most.max(sample.abs()))
}

#[test]
fn worklet_plays_the_same_as_a_synth() {
    let mut worklet = Worklet::new(44_100);
    let mut synth = Synth::new(44_100);
    let mut message = Message::default();
    message.hear(&SOUNDSCAPE);
    message.play(Cue::Menu(Menu::Back));
    tell(&mut worklet, message.bytes());
    synth.set_soundscape(&SOUNDSCAPE);
    synth.play(Cue::Menu(Menu::Back));
    for _ in 0..100 {
        let mut samples = [0.0; 2 * MOST_FRAMES];
        synth.render(&mut samples);
        assert!(loudest(&samples) > 0.0);
        assert_eq!(worklet.render(MOST_FRAMES), samples);
    }
}

#[test]
fn worklet_falls_silent_without_messages() {
    let mut worklet = Worklet::new(48_000);
    let mut message = Message::default();
    let music = false;
    message.hear(&Soundscape {
        music,
        ..SOUNDSCAPE
    });
    tell(&mut worklet, message.bytes());
    let mut second = || {
        (0..375)
            .map(|_| loudest(worklet.render(MOST_FRAMES)))
            .fold(0.0, f32::max)
    };
    assert!(second() > 0.1);
    second();
    assert!(second() < 1e-3);
}

#[test]
fn invalid_lengths_and_rates_are_clamped() {
    let mut worklet = Worklet::new(0);
    worklet.message().fill(2);
    worklet.take(usize::MAX);
    assert_eq!(worklet.render(usize::MAX).len(), 2 * MOST_FRAMES);
    assert!(worklet.render(0).is_empty());
    assert_eq!(worklet.render(1).len(), 2);
}

#[test]
fn messages_and_rendering_allocate_no_memory() {
    let mut worklet = Worklet::new(48_000);
    let mut message = Message::default();
    for _ in 0..1000 {
        message.play(Cue::Tear {
            energy: 2.0,
            x: 0.0,
        });
    }
    message.hear(&SOUNDSCAPE);
    let before = TAKEN.get();
    assert!(before > 0);
    for _ in 0..100 {
        tell(&mut worklet, message.bytes());
        assert!(loudest(worklet.render(MOST_FRAMES)) <= 1.0);
    }
    assert_eq!(TAKEN.get() - before, 0);
}
