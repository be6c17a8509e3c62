//! What is felt of them.

use super::*;
use force_feedback::{Ability, Force, LENGTH, Manner, Output, Settings, Sink, State, Stop};

const PATIENCE: Duration = Duration::from_secs(20);

fn until(what: &str, mut holds: impl FnMut() -> bool) {
    let end = Instant::now() + PATIENCE;
    while !holds() {
        assert!(Instant::now() < end, "never happened: {what}");
        thread::sleep(Duration::from_millis(1));
    }
}

#[test]
fn a_pad_rumbles_and_stops_by_itself() {
    let sticks = open();
    let pad = sticks.plug_in_pad("Pad").expect("SDL takes it");
    let mut haptic = sticks.haptic(pad.id());
    until("it can rumble", || haptic.ability() == Ability::Rumble);
    assert_eq!(haptic.aim(), Ok([0.0; 2]));
    assert_eq!(pad.rumble(), [0, 0]);
    let hum = Output::Rumble {
        low: 0.5,
        high: 1.0,
    };
    let mut start = Instant::now();
    until("it rumbles", || {
        start = Instant::now();
        assert!(haptic.play(hum).is_ok());
        pad.rumble() == [32768, 65534]
    });
    until("it ends", || pad.rumble() == [0, 0]);
    // SDL counts whole milliseconds.
    let length = start.elapsed() + Duration::from_millis(2);
    assert!(length >= LENGTH, "{length:?}");

    drop(haptic);
    // On a busy machine it may take long now and then.
    let is_quick = (0..20).any(|_try| {
        let mut haptic = sticks.haptic(pad.id());
        until("it can rumble", || haptic.ability() == Ability::Rumble);
        until("it rumbles again", || {
            assert!(haptic.play(hum).is_ok());
            pad.rumble() == [32768, 65534]
        });
        let start = Instant::now();
        drop(haptic);
        until("it is let go", || pad.rumble() == [0, 0]);
        start.elapsed() < LENGTH / 2
    });
    assert!(is_quick, "to drop it is to let go");
}

#[test]
fn a_device_that_is_taken_over_can_still_be_felt() {
    let sticks = open();
    let pad = sticks.plug_in_pad("Pad").expect("SDL takes it");
    let old = sticks.haptic(pad.id());
    // As a line that is replaced: the new one comes first, since the old one is dropped on another thread.
    let mut new = sticks.haptic(pad.id());
    drop(old);
    let hum = Output::Rumble {
        low: 0.5,
        high: 1.0,
    };
    until("it can rumble", || new.ability() == Ability::Rumble);
    until("it rumbles", || {
        assert!(new.play(hum).is_ok());
        pad.rumble() == [32768, 65534]
    });
}

#[test]
fn what_was_on_its_way_for_too_long_is_not_played() {
    let sticks = open();
    let pad = sticks.plug_in_pad("Pad").expect("SDL takes it");
    let mut haptic = sticks.haptic(pad.id());
    until("it can rumble", || haptic.ability() == Ability::Rumble);
    let orders = sticks.owner.orders().upgrade().expect("it runs");
    // As in a process that is stopped.
    orders
        .send(Box::new(|_| thread::sleep(LENGTH)))
        .expect("it runs");
    let hum = Output::Rumble {
        low: 0.5,
        high: 1.0,
    };
    assert!(haptic.play(hum).is_ok());
    let (tell, told) = std::sync::mpsc::channel();
    orders
        .send(Box::new(move |_| tell.send(()).expect("the test waits")))
        .expect("it runs");
    told.recv().expect("the thread runs");
    assert_eq!(pad.rumble(), [0, 0]);
}

#[test]
fn what_pushes_is_not_told_to_shake() {
    let sticks = open();
    let stick = sticks
        .plug_in_stick("Stick", 2, 1, 0)
        .expect("SDL takes it");
    let mut haptic = sticks.haptic(stick.id());
    until("SDL makes none with motors", || {
        haptic.ability() == Ability::Rumble
    });
    assert!(haptic.play(Output::Force([1.0, 0.0])).is_ok());
    sticks.snapshot();
    let pad = sticks.plug_in_pad("Later").expect("SDL takes it");
    assert_eq!(stick.rumble(), [0, 0]);
    assert_eq!(pad.rumble(), [0, 0]);
}

#[test]
fn all_of_it_up_to_the_pad() {
    let sticks = open();
    let pads = ["One", "Two"].map(|name| sticks.plug_in_pad(name).expect("SDL takes it"));
    let force = Force::start(250).expect("the system has a thread");
    let lines = [&pads[0], &pads[1]]
        .map(|pad| force.add(Box::new(sticks.haptic(pad.id())), Settings::default()));
    let push = State {
        contact: [-300.0, 0.0],
        manner: Manner::CellIndexing,
    };
    until("the one rumbles", || {
        lines[0].feel(push);
        pads[0].rumble()[0] > 10_000
    });
    assert_eq!(pads[1].rumble(), [0, 0], "each has its own");
    until("a tear ticks", || {
        lines[0].feel(push);
        lines[0].tear(1.0);
        pads[0].rumble()[1] > 10_000
    });
    lines[0].stop(Stop::Paused);
    until("it rests", || pads[0].rumble() == [0, 0]);

    let [one, two] = pads;
    until("it rumbles before it is unplugged", || {
        lines[0].feel(push);
        one.rumble()[0] > 0
    });
    drop(one);
    until("its line says so", || {
        lines[0].feel(push);
        lines[0].report().silent == Some(Stop::Unplugged)
    });
    until("the other goes on", || {
        lines[1].feel(push);
        two.rumble()[0] > 0
    });
    drop(force);
    until("nothing stays on", || two.rumble() == [0, 0]);
}

#[test]
fn nothing_is_felt_of_what_is_not_there() {
    let sticks = open();
    let pad = sticks.plug_in_pad("Pad").expect("SDL takes it");
    let id = pad.id();
    drop(pad);
    let mut haptic = sticks.haptic(id);
    assert!(haptic.aim().is_err());
    assert_eq!(haptic.ability(), Ability::Nothing);
    drop(sticks);
    assert!(haptic.play(Output::Force([1.0; 2])).is_err());
}
