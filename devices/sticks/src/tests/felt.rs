//! Tests of force feedback with virtual devices.

use super::*;
use force_feedback::{
    Ability, ForceThread, OUTPUT_DURATION, Output, Settings, Sink, State, StickMode, Stop,
};

const PATIENCE: Duration = Duration::from_secs(20);
const HUM: Output = Output::Rumble {
    low: 0.5,
    high: 1.0,
};

fn until(what: &str, mut holds: impl FnMut() -> bool) {
    let end = Instant::now() + PATIENCE;
    while !holds() {
        assert!(Instant::now() < end, "never happened: {what}");
        thread::sleep(Duration::from_millis(1));
    }
}

#[test]
fn pad_rumble_ends_by_itself_and_on_drop() {
    let (sticks, pad) = open_with_pad();
    let mut haptic = sticks.haptic(pad.id());
    until("the pad can rumble", || haptic.ability() == Ability::Rumble);
    assert_eq!(haptic.stick_position(), Ok([0.0; 2]));
    assert_eq!(pad.rumble(), [0, 0]);
    let mut start = Instant::now();
    until("the pad rumbles", || {
        start = Instant::now();
        assert!(haptic.play(HUM).is_ok());
        pad.rumble() == [32768, 65534]
    });
    until("the rumble ends", || pad.rumble() == [0, 0]);
    // Allows 2 ms more, because SDL counts whole milliseconds.
    let length = start.elapsed() + Duration::from_millis(2);
    assert!(length >= OUTPUT_DURATION, "{length:?}");

    drop(haptic);
    // One quick try of twenty suffices, because a busy machine may be slow now and then.
    let is_quick = (0..20).any(|_try| {
        let mut haptic = sticks.haptic(pad.id());
        until("the pad can rumble", || haptic.ability() == Ability::Rumble);
        until("the pad rumbles again", || {
            assert!(haptic.play(HUM).is_ok());
            pad.rumble() == [32768, 65534]
        });
        let start = Instant::now();
        drop(haptic);
        until("the pad stops", || pad.rumble() == [0, 0]);
        start.elapsed() < OUTPUT_DURATION / 2
    });
    assert!(is_quick, "dropping the sink does not stop the pad in time");
}

#[test]
fn new_sink_works_after_the_old_one_is_dropped() {
    let (sticks, pad) = open_with_pad();
    let old = sticks.haptic(pad.id());
    // The new sink is created before the old one is dropped, as when the line of a `ForceThread` is replaced:
    // its thread drops the old sink later.
    let mut new = sticks.haptic(pad.id());
    drop(old);
    until("the pad can rumble", || new.ability() == Ability::Rumble);
    until("the pad rumbles", || {
        assert!(new.play(HUM).is_ok());
        pad.rumble() == [32768, 65534]
    });
}

#[test]
fn obsolete_output_is_not_played() {
    let (sticks, pad) = open_with_pad();
    let mut haptic = sticks.haptic(pad.id());
    until("the pad can rumble", || haptic.ability() == Ability::Rumble);
    // Blocks the SDL thread, as in a stopped process.
    order(&sticks, |_| thread::sleep(OUTPUT_DURATION));
    assert!(haptic.play(HUM).is_ok());
    let (tell, told) = std::sync::mpsc::channel();
    order(&sticks, move |_| tell.send(()).expect("the test waits"));
    told.recv().expect("the task has run");
    assert_eq!(pad.rumble(), [0, 0]);
}

#[test]
fn force_output_does_not_rumble() {
    let sticks = open();
    let stick = stick(&sticks, "Stick", 2, 1, 0);
    let mut haptic = sticks.haptic(stick.id());
    until("a virtual stick can only rumble", || {
        haptic.ability() == Ability::Rumble
    });
    assert!(haptic.play(Output::Force([1.0, 0.0])).is_ok());
    sticks.snapshot();
    let pad = sticks.plug_in_pad("Later").expect("valid device");
    assert_eq!(stick.rumble(), [0, 0]);
    assert_eq!(pad.rumble(), [0, 0]);
}

#[test]
fn force_thread_drives_pads_until_they_are_unplugged() {
    let sticks = open();
    let pads = ["One", "Two"].map(|name| sticks.plug_in_pad(name).expect("valid device"));
    let force = ForceThread::start(250).expect("a thread can be started");
    let lines = [&pads[0], &pads[1]]
        .map(|pad| force.add(Box::new(sticks.haptic(pad.id())), Settings::default()));
    let push = State {
        contact: [-300.0, 0.0],
        manner: StickMode::Position,
    };
    until("the first pad rumbles", || {
        lines[0].set_state(push);
        pads[0].rumble()[0] > 10_000
    });
    assert_eq!(pads[1].rumble(), [0, 0], "the other pad rumbles too");
    until("a tear is felt", || {
        lines[0].set_state(push);
        lines[0].tear(1.0);
        pads[0].rumble()[1] > 10_000
    });
    lines[0].stop(Stop::Paused);
    until("the pad stops", || pads[0].rumble() == [0, 0]);

    let [one, two] = pads;
    until("the pad rumbles before it is unplugged", || {
        lines[0].set_state(push);
        one.rumble()[0] > 0
    });
    drop(one);
    until("the line reports it", || {
        lines[0].set_state(push);
        lines[0].report().silent == Some(Stop::Unplugged)
    });
    until("the other pad still rumbles", || {
        lines[1].set_state(push);
        two.rumble()[0] > 0
    });
    drop(force);
    until("all pads stop", || two.rumble() == [0, 0]);
}

#[test]
fn sink_of_a_missing_device_does_nothing() {
    let (sticks, pad) = open_with_pad();
    let id = pad.id();
    drop(pad);
    let mut haptic = sticks.haptic(id);
    assert!(haptic.stick_position().is_err());
    assert_eq!(haptic.ability(), Ability::Nothing);
    drop(sticks);
    assert!(haptic.play(Output::Force([1.0; 2])).is_err());
}
