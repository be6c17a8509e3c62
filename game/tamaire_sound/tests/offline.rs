//! Tests that measure rendered samples.

use tamaire_sound::{Cue, Menu, Mute, Press, Route, Soundscape, Synth, Volumes};

const RATE: u32 = 48_000;

/// One loud cue of each kind.
const CUES: [Cue; 11] = [
    Cue::Snap { x: 0.5 },
    Cue::Switch {
        is_on: true,
        x: -0.5,
    },
    Cue::Thud {
        impulse: 30.0,
        x: -1.0,
    },
    Cue::Tear {
        energy: 10.0,
        x: 1.0,
    },
    Cue::Crumb { speed: 2.0, x: 0.0 },
    Cue::Won(Route::Squeeze),
    Cue::Won(Route::Shave),
    Cue::Won(Route::Mix),
    Cue::Menu(Menu::Move),
    Cue::Menu(Menu::Confirm),
    Cue::Menu(Menu::Back),
];

fn pressed(force: f32, slip: f32) -> Soundscape {
    let press = Press {
        force,
        slip,
        x: 0.0,
    };
    Soundscape {
        presses: [press, Press::default()],
        ..Soundscape::default()
    }
}

/// Renders a soundscape that may differ in each tick, and returns the left channel.
fn render(synth: &mut Synth, seconds: f32, soundscape: impl Fn(f32) -> Soundscape) -> Vec<f32> {
    let mut left = Vec::new();
    let mut tick = [0.0; 2 * RATE as usize / 60];
    for time in 0..(60.0 * seconds) as usize {
        synth.set_soundscape(&soundscape(time as f32 / 60.0));
        synth.render(&mut tick);
        assert!(
            tick.iter().all(|sample| sample.abs() <= 1.0),
            "beyond full scale, or not finite"
        );
        left.extend(tick.iter().step_by(2));
    }
    left
}

fn steady(synth: &mut Synth, seconds: f32, soundscape: Soundscape) -> Vec<f32> {
    render(synth, seconds, |_| soundscape)
}

fn loudness(samples: &[f32]) -> f32 {
    (samples.iter().map(|k| k * k).sum::<f32>() / samples.len() as f32).sqrt()
}

/// Returns the RMS frequency of samples [Hz]. It follows from the ratio of two powers: that of the
/// differences between samples, and that of the samples.
fn centroid(samples: &[f32]) -> f32 {
    let power: f32 = samples.iter().map(|k| k * k).sum();
    let difference: f32 = samples.windows(2).map(|k| (k[1] - k[0]).powi(2)).sum();
    (difference / power).sqrt() * RATE as f32 / std::f32::consts::TAU
}

/// Returns the roughness of samples: the largest step between neighbouring ones. A click has a large step, and
/// even a loud sound has only far smaller ones.
fn roughest(samples: &[f32]) -> f32 {
    let step = |k: &[f32]| (k[1] - k[0]).abs();
    samples.windows(2).map(step).fold(0.0, f32::max)
}

#[test]
fn synth_is_silent_without_sounds() {
    let mut synth = Synth::new(RATE);
    assert!(
        steady(&mut synth, 0.5, Soundscape::default())
            .iter()
            .all(|k| *k == 0.0)
    );
}

#[test]
fn synth_falls_silent_after_all_sounds() {
    let mut synth = Synth::new(RATE);
    for cue in CUES {
        synth.play(cue);
    }
    let all = Soundscape {
        squash: 0.5,
        hold: 0.9,
        rewind: false,
        music: true,
        ..pressed(1000.0, 1.0)
    };
    assert!(loudness(&steady(&mut synth, 1.0, all)) > 0.05);
    steady(&mut synth, 25.0, Soundscape::default());
    assert_eq!(synth.voice_count(), 0);
    let rest = steady(&mut synth, 0.5, Soundscape::default());
    assert!(rest.iter().all(|k| *k == 0.0), "still {}", loudness(&rest));
}

#[test]
fn press_is_louder_and_higher_with_more_force() {
    let heard = [50.0, 200.0, 500.0, 1200.0].map(|force| {
        let samples = steady(&mut Synth::new(RATE), 1.5, pressed(force, 0.5));
        (loudness(&samples), centroid(&samples))
    });
    for pair in heard.windows(2) {
        assert!(pair[1].0 > 1.2 * pair[0].0, "not louder: {heard:?}");
        assert!(pair[1].1 > 1.1 * pair[0].1, "not higher: {heard:?}");
    }
}

#[test]
fn slipping_press_is_louder_than_a_resting_one() {
    let [rests, slips] = [0.0, 0.5].map(|slip| {
        loudness(&steady(&mut Synth::new(RATE), 1.5, pressed(400.0, slip))[RATE as usize / 2..])
    });
    assert!(slips > 3.0 * rests, "slipping {slips}, resting {rests}");
}

#[test]
fn cues_are_louder_with_larger_amounts() {
    let loud = |cue| {
        let mut synth = Synth::new(RATE);
        synth.play(cue);
        loudness(&steady(&mut synth, 0.5, Soundscape::default()))
    };
    let rises = |cue: fn(f32) -> Cue, amounts: [f32; 3]| {
        let heard = amounts.map(|amount| loud(cue(amount)));
        assert!(
            heard[0] > 0.0 && heard[1] > 1.3 * heard[0] && heard[2] > 1.1 * heard[1],
            "{heard:?}"
        );
    };
    rises(|impulse| Cue::Thud { impulse, x: 0.0 }, [0.5, 5.0, 40.0]);
    rises(|energy| Cue::Tear { energy, x: 0.0 }, [0.05, 0.5, 10.0]);
    rises(|speed| Cue::Crumb { speed, x: 0.0 }, [0.1, 0.5, 4.0]);
}

#[test]
fn chord_rises_with_the_hold() {
    let at = |hold| {
        let samples = steady(
            &mut Synth::new(RATE),
            1.0,
            Soundscape {
                hold,
                ..Soundscape::default()
            },
        );
        (loudness(&samples), centroid(&samples[RATE as usize / 2..]))
    };
    let (early, late) = (at(0.2), at(0.9));
    assert!(
        late.0 > early.0 && late.1 > 1.2 * early.1,
        "{early:?} {late:?}"
    );
}

#[test]
fn squash_causes_a_decaying_wobble() {
    let squash = |time| Soundscape {
        squash: if time < 0.1 { 0.0 } else { 0.4 },
        ..Soundscape::default()
    };
    let samples = render(&mut Synth::new(RATE), 2.5, squash);
    let second = RATE as usize;
    assert!(loudness(&samples[second / 10..second / 2]) > 0.02);
    assert!(loudness(&samples[2 * second..]) < 1e-4);
    assert!(
        centroid(&samples[..second / 2]) < 300.0,
        "the pitch is too high"
    );
}

#[test]
fn soundscape_changes_do_not_click() {
    let states = [
        pressed(0.0, 0.0),
        pressed(1500.0, 1.0),
        Soundscape {
            hold: 1.0,
            rewind: false,
            ..pressed(0.0, 0.0)
        },
        Soundscape {
            squash: 0.6,
            ..pressed(800.0, 0.0)
        },
        Soundscape {
            hush: Mute::Everything,
            ..pressed(800.0, 0.7)
        },
        Soundscape {
            hush: Mute::World,
            ..pressed(800.0, 0.7)
        },
    ];
    let usual = roughest(&steady(&mut Synth::new(RATE), 2.0, pressed(1500.0, 1.0)));
    for from in states {
        for to in states {
            // Switches the sounds at several moments, because a tone cut off at a zero crossing does not
            // click.
            let change = |time: f32| {
                if (4.0 * time).fract() < 0.5 { from } else { to }
            };
            let found = roughest(&render(&mut Synth::new(RATE), 2.0, change));
            assert!(
                found < 1.25 * usual,
                "{found} after {usual}, from {from:?} to {to:?}"
            );
        }
    }
    // For comparison: a sine of 1 kHz at half scale has a roughness of 0.065.
    assert!(usual < 0.1, "{usual}");
}

#[test]
fn volume_changes_and_cut_off_voices_do_not_click() {
    let mut synth = Synth::new(RATE);
    let mut samples = Vec::new();
    for tick in 0..60 {
        let master = (tick % 2) as f32;
        synth.set_volumes(&Volumes {
            master,
            ..Volumes::default()
        });
        // Starts more grains than the maximum number of voices, so that some are cut off.
        for _ in 0..100 {
            synth.play(Cue::Menu(Menu::Confirm));
        }
        samples.extend(steady(&mut synth, 1.0 / 60.0, Soundscape::default()));
    }
    // A click is a sudden change of slope. High tones at full scale have steep slopes but no such change.
    let slopes: Vec<f32> = samples.windows(2).map(|k| k[1] - k[0]).collect();
    let found = roughest(&slopes);
    assert!(found < 0.1, "{found}");
}

#[test]
fn cue_is_heard_within_64_frames_without_a_click() {
    for cue in CUES {
        let mut synth = Synth::new(RATE);
        synth.play(cue);
        let mut block = [0.0; 128];
        synth.render(&mut block);
        let loudest = block.iter().fold(0.0, |most: f32, k| most.max(k.abs()));
        assert!(loudest > 1e-3, "{cue:?}: {loudest}");
        assert!(
            block[..2].iter().all(|k| k.abs() < 0.02),
            "{cue:?} begins with a click"
        );
    }
}

#[test]
fn voice_count_is_bounded() {
    let mut synth = Synth::new(RATE);
    let mut most = 0;
    for _ in 0..10 {
        for number in 0..1000 {
            synth.play(CUES[number % CUES.len()]);
        }
        most = most.max(synth.voice_count());
        steady(&mut synth, 0.02, pressed(1e6, 1e3));
    }
    assert!((10..=64).contains(&most), "{most} voices");
}

#[test]
fn non_finite_numbers_are_harmless() {
    let mut synth = Synth::new(0);
    let bad = [
        f32::NAN,
        f32::INFINITY,
        f32::NEG_INFINITY,
        f32::MAX,
        -1.0,
        f32::MIN_POSITIVE,
    ];
    for a in bad {
        for b in bad {
            let press = Press {
                force: a,
                slip: b,
                x: a,
            };
            let (impulse, energy, speed, x) = (a, a, a, b);
            synth.play(Cue::Thud { impulse, x });
            synth.play(Cue::Tear { energy, x });
            synth.play(Cue::Crumb { speed, x });
            synth.play(Cue::Snap { x });
            synth.play(Cue::Switch { is_on: true, x });
            synth.set_volumes(&Volumes {
                master: a,
                effects: b,
                music: a,
                interface: b,
            });
            let soundscape = Soundscape {
                presses: [press; 2],
                squash: a,
                hold: b,
                rewind: false,
                ..Soundscape::default()
            };
            steady(&mut synth, 0.05, soundscape);
        }
    }
    synth.set_volumes(&Volumes::default());
    steady(&mut synth, 3.0, Soundscape::default());
    let after = steady(&mut synth, 0.5, Soundscape::default());
    assert!(after.iter().all(|k| *k == 0.0), "not silent");
    let after = steady(&mut synth, 0.5, pressed(400.0, 0.5));
    assert!(loudness(&after) > 0.01, "silent after valid input");
}

#[test]
fn press_on_the_left_is_louder_on_the_left() {
    let mut synth = Synth::new(RATE);
    let press = Press {
        force: 400.0,
        slip: 0.5,
        x: -1.0,
    };
    synth.set_soundscape(&Soundscape {
        presses: [press, Press::default()],
        ..Soundscape::default()
    });
    let mut samples = [0.0; 9600];
    synth.render(&mut samples);
    let side = |from: usize| {
        loudness(
            &samples
                .iter()
                .skip(from)
                .step_by(2)
                .copied()
                .collect::<Vec<_>>(),
        )
    };
    assert!(side(0) > 2.5 * side(1));
}

#[test]
fn resting_contact_thuds_once() {
    let thuds = |impulse: fn(u32) -> f32| {
        let mut synth = Synth::new(RATE);
        let mut started = 0;
        for tick in 0..60 {
            let before = synth.voice_count();
            synth.play(Cue::Thud {
                impulse: impulse(tick),
                x: 0.0,
            });
            started += synth.voice_count() - before;
            steady(&mut synth, 1.0 / 60.0, Soundscape::default());
        }
        started
    };
    assert_eq!(thuds(|tick| 8.0 + (tick % 3) as f32), 1);
    assert_eq!(thuds(|tick| if tick % 30 == 0 { 8.0 } else { 0.0 }), 2);
}

#[test]
fn volumes_and_hush_mute_their_sounds() {
    let heard = |volumes: Volumes, hush| {
        let mut synth = Synth::new(RATE);
        synth.set_volumes(&volumes);
        let soundscape = Soundscape {
            hush,
            ..pressed(600.0, 0.5)
        };
        steady(&mut synth, 0.5, soundscape);
        let world = loudness(&steady(&mut synth, 0.3, soundscape));
        synth.play(Cue::Menu(Menu::Confirm));
        let silent = Soundscape {
            hush,
            ..Soundscape::default()
        };
        steady(&mut synth, 0.05, silent);
        (
            world > 1e-4,
            loudness(&steady(&mut synth, 0.1, silent)) > 1e-3,
        )
    };
    let all = Volumes::default();
    assert_eq!(heard(all, Mute::Nothing), (true, true));
    assert_eq!(heard(all, Mute::World), (false, true));
    assert_eq!(heard(all, Mute::Everything), (false, false));
    let deaf = Volumes {
        effects: 0.0,
        ..all
    };
    assert_eq!(heard(deaf, Mute::Nothing), (false, true));
    let deaf = Volumes {
        interface: 0.0,
        ..deaf
    };
    assert_eq!(heard(deaf, Mute::Nothing), (false, false));
    assert_eq!(
        heard(Volumes { master: 0.0, ..all }, Mute::Nothing),
        (false, false)
    );
}

#[test]
fn sound_of_a_hanging_game_ends() {
    let mut synth = Synth::new(RATE);
    synth.set_soundscape(&pressed(600.0, 0.5));
    let mut samples = vec![0.0; 4 * RATE as usize];
    synth.render(&mut samples);
    assert!(loudness(&samples[..RATE as usize / 2]) > 0.01);
    assert!(loudness(&samples[3 * RATE as usize..]) < 1e-4);
}

#[test]
fn each_song_sounds_different_and_none_is_louder_than_the_others() {
    let songs: Vec<Vec<f32>> = (0..=5)
        .map(|song| {
            let mut synth = Synth::new(RATE);
            let music = Soundscape {
                music: true,
                song,
                ..Soundscape::default()
            };
            steady(&mut synth, 20.0, music)
        })
        .collect();
    let loud: Vec<f32> = songs.iter().map(|samples| loudness(samples)).collect();
    for (song, samples) in songs.iter().enumerate() {
        assert!((0.5..2.0).contains(&(loud[song] / loud[0])), "{loud:?}");
        assert!(songs[..song].iter().all(|other| other != samples), "{song}");
    }
    // Another number than those of the songs plays the last one.
    let mut synth = Synth::new(RATE);
    let music = Soundscape {
        music: true,
        song: 200,
        ..Soundscape::default()
    };
    assert_eq!(steady(&mut synth, 20.0, music), songs[5]);
}

#[test]
fn equal_calls_give_equal_samples() {
    let run = || {
        let mut synth = Synth::new(44_100);
        CUES.iter().for_each(|cue| synth.play(*cue));
        steady(
            &mut synth,
            1.0,
            Soundscape {
                music: true,
                ..pressed(600.0, 0.5)
            },
        )
    };
    assert_eq!(run(), run());
}
