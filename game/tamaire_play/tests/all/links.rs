//! Tests of links to rounds and levels. With `--nocapture` they print the lengths of the links.

use fastrand::Rng;
use fuwafuwa::Vec3;
use std::collections::BTreeSet;
use std::sync::Arc;
use tamaire_play::level::{NAMED, built_in};
use tamaire_play::link::{MAX_LENGTH, address, is_link};
use tamaire_play::{
    AnyRound, Assist, Bot, BotKind, InputFrame, Level, Link, LinkError, Playback, Replay,
    ReplayError,
};

/// Maximum length of the link to a typical round of Classic [characters].
const USUAL: usize = 2_000;

fn open(id: &str) -> Arc<Level> {
    Arc::new(Level::open(id).unwrap())
}

fn changed(id: &str, from: &str, to: &str) -> Arc<Level> {
    let (_, text) = NAMED.iter().find(|(known, _)| *known == id).unwrap();
    assert!(text.contains(from), "{from}");
    let text = text.replace(from, to);
    let nothing = |_: &str| Err(std::io::ErrorKind::NotFound.into());
    Arc::new(Level::read("mine.toml", text.as_bytes(), &nothing).unwrap())
}

/// Lets a bot play a round for at most `ticks` ticks, and returns the replay.
fn played(level: &Arc<Level>, kind: BotKind, seed: u64, ticks: usize) -> Replay {
    let mut round = AnyRound::new(level.clone());
    round.play(&mut Bot::new(kind, seed), ticks);
    round.replay()
}

fn read_round(text: &str) -> Replay {
    match Link::read(text).unwrap() {
        Link::Round(replay) => *replay,
        Link::Level(level) => panic!("a level: {}", level.id),
    }
}

fn read_level(text: &str) -> Level {
    match Link::read(text).unwrap() {
        Link::Level(level) => *level,
        Link::Round(replay) => panic!("a round in {}", replay.level),
    }
}

fn watch(replay: Replay) -> Result<(), ReplayError> {
    let mut playback = Playback::new(Arc::new(replay))?;
    while !playback.is_over() {
        playback.step()?;
    }
    Ok(())
}

fn frames(replay: &Replay) -> Vec<InputFrame> {
    (0..replay.ticks()).map(|tick| replay.frame(tick)).collect()
}

/// Checks that reading the link to a round restores the round. Returns the link.
fn check(replay: &Replay) -> String {
    let link = replay.link().unwrap();
    let read = read_round(&link);
    assert_eq!(frames(&read), frames(replay));
    assert_eq!(read.outcome, replay.outcome);
    assert_eq!((&read.game, &read.level), (&replay.game, &replay.level));
    assert_eq!(read.level().unwrap(), replay.level().unwrap());
    assert_eq!(read.link().unwrap(), link);
    link
}

/// Breaks a text into lines of at most 76 characters, as mail programs do.
fn wrapped(text: &str, line_end: &str) -> String {
    let letters: Vec<char> = text.chars().collect();
    let lines = letters
        .chunks(76)
        .map(|line| line.iter().collect::<String>());
    lines.collect::<Vec<_>>().join(line_end)
}

#[test]
fn link_survives_mail_and_chat() {
    let replay = played(&open("classic"), BotKind::Squeeze, 1, 3600);
    for fragment in [replay.link().unwrap(), replay.code().unwrap()] {
        let link = address("https://example.org/play/?a=b", &fragment);
        // Longer than two lines of a mail.
        assert!(link.len() > 2 * 76, "{}", link.len());
        let percent = |text: &str| {
            let encoded = |letter: char| match letter.is_ascii_alphanumeric() {
                true => letter.to_string(),
                false => format!("%{:02X}", u32::from(letter)),
            };
            text.chars().map(encoded).collect::<String>()
        };
        let quoted_printable = link.replace('=', "=3D");
        for sent in [
            fragment.clone(),
            link.replace('#', "%23"),
            percent(&link),
            percent(&percent(&link)),
            format!("<{link}>"),
            format!("\"{link}\""),
            format!("「{link}」です。"),
            format!("({link})."),
            format!("[watch]({link}), please"),
            format!("{link}."),
            format!("{link}, and more: read this"),
            format!("  {link}\u{200b}\r\n\r\n-- \r\nA sender"),
            wrapped(&link, "\r\n"),
            wrapped(&link, "\n> "),
            wrapped(&link, " "),
            format!("<{}>", wrapped(&link, "\n")),
            wrapped(&quoted_printable, "=\r\n"),
            link.replace('_', "\\_"),
            link.replace("/play", "/pl#ay"),
        ] {
            assert!(read_round(&sent) == replay_of(&fragment), "{sent}");
        }
    }
    let link = address("https://example.org/", &replay.link().unwrap());
    assert!(is_link(&link) && is_link(&link.replace('#', "%23")) && is_link("<https://a.b>"));
    assert!(!is_link("my level.toml") && !is_link("#1.toml") && !is_link("classic"));
    let cut = &link[..link.len() - 40];
    for sent in [
        cut.to_string(),
        wrapped(cut, "\n"),
        format!("{cut} and more"),
    ] {
        let error = Link::read(&sent).unwrap_err();
        assert!(
            matches!(error, LinkError::CutShort | LinkError::Damaged),
            "{error}"
        );
    }
    for other in [
        "",
        "#",
        "https://example.org/",
        "hello",
        "%",
        "%2",
        "=",
        "#r",
        "%23r1",
    ] {
        assert!(Link::read(other).is_err(), "{other}");
    }
}

fn replay_of(fragment: &str) -> Replay {
    Replay::of_fragment(fragment).unwrap()
}

fn tell(what: &str, ticks: usize, link: &str) {
    let (seconds, length) = (ticks as f32 / 60.0, link.len());
    let rate = length as f32 / seconds;
    println!("{what:>24} {seconds:5.1} s {length:6} characters, {rate:5.1} per second");
}

#[test]
fn link_of_a_typical_round_is_short_and_playable() {
    let classic = open("classic");
    for (name, kind) in [("squeeze", BotKind::Squeeze), ("shave", BotKind::Shave)] {
        for seed in 1..=4 {
            let replay = played(&classic, kind, seed, 3600);
            assert!(replay.outcome.is_some());
            let link = check(&replay);
            tell(&format!("{name} {seed}"), replay.ticks(), &link);
            // A bot that shaves may need most of a minute.
            let limit = USUAL.max(120 * replay.ticks() / 60);
            assert!(link.len() <= limit, "{name} {seed}: {}", link.len());
            if seed == 1 {
                watch(read_round(&link)).unwrap();
            }
        }
    }
}

/// Returns input frames of a simulated mouse player: minimum-jerk strokes [Flash 1985] and rests, with a
/// tremor of about 9 Hz. The positions are sampled at `rate` [Hz] and rounded to multiples of `grain`, in
/// units of 1/8192 m.
fn hand(seed: u64, seconds: usize, rate: f32, grain: f32) -> Vec<InputFrame> {
    const STEPS: usize = 1000;
    let mut random = Rng::with_seed(seed);
    let mut noise = move || (0..12).map(|_| random.f32()).sum::<f32>() - 6.0;
    let mut random = Rng::with_seed(seed + 1000);
    let mut way: Vec<[f32; 2]> = Vec::new();
    let mut here = [-1.4_f32, 0.0];
    while way.len() < seconds * STEPS {
        let rests = random.f32() < 0.35;
        let there = [3.0 * random.f32() - 1.5, 1.8 * random.f32() - 0.9];
        let far = (there[0] - here[0]).hypot(there[1] - here[1]);
        let (there, duration) = match rests {
            true => (here, 0.1 + 0.5 * random.f32()),
            false => (there, 0.25 + far * (0.25 + 0.75 * random.f32())),
        };
        let bend = [0.1 * noise(), 0.1 * noise()].map(|k| if rests { 0.0 } else { k });
        let steps = (duration * STEPS as f32) as usize;
        way.extend((0..steps).map(|step| {
            let s = step as f32 / steps as f32;
            let share = s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
            let aside = 16.0 * (s - s * s) * (s - s * s);
            [0, 1].map(|k| here[k] + share * (there[k] - here[k]) + aside * bend[k])
        }));
        here = there;
    }
    // Simulates the tremor as the output of a 9 Hz resonator driven by noise.
    let (pull, decay) = (
        2.0 * (std::f32::consts::TAU * 9.0 / STEPS as f32).cos(),
        0.99,
    );
    let mut tremor = [[0.0_f32; 2]; 2];
    for place in &mut way {
        for axis in 0..2 {
            let [last, before] = tremor[axis];
            let next = pull * decay * last - decay * decay * before + 1e-5 * noise();
            tremor[axis] = [next, last];
            place[axis] += next;
        }
    }
    let frame = |tick: usize| {
        // A frame repeats the position at the last time when the mouse was read.
        let read = (tick as f32 / 60.0 * rate).floor() / rate;
        let [x, y] = way[(read * STEPS as f32) as usize];
        let rounded = |k: f32| (k * 8192.0 / grain).round() * grain / 8192.0;
        InputFrame::towards(Vec3::new(rounded(x), rounded(y), 0.0))
    };
    (0..60 * seconds).map(frame).collect()
}

fn played_by_hand(frames: Vec<InputFrame>) -> Replay {
    let mut round = AnyRound::new(open("classic"));
    for frame in frames {
        round.step(frame);
    }
    assert_eq!(round.progress().outcome, None);
    round.replay()
}

#[test]
fn link_reproduces_mouse_input_exactly() {
    let rows = [
        (20, 125.0, 8.0, 80.0),
        (20, 125.0, 1.0, 135.0),
        (30, 60.0, 1.0, 135.0),
        (30, 125.0, 1.0, 135.0),
        (30, 1000.0, 1.0, 135.0),
        (60, 125.0, 1.0, 135.0),
        (30, 125.0, 8.0, 80.0),
        (30, 30.0, 8.0, 80.0),
    ];
    for (seconds, rate, grain, most) in rows {
        let replay = played_by_hand(hand(1, seconds, rate, grain));
        let link = check(&replay);
        tell(
            &format!("hand, {rate} Hz, {grain}/8192 m"),
            replay.ticks(),
            &link,
        );
        let length = link.len() as f32 / seconds as f32;
        assert!(length < most, "{rate} Hz: {length} characters per second");
    }
}

#[test]
fn link_reproduces_two_hands_that_come_and_go() {
    for id in ["classic", "classic-3d"] {
        let mut round = AnyRound::new(open(id));
        let mut random = Rng::with_seed(7);
        for tick in 0..90 {
            let mut frame = InputFrame::default();
            let place = Vec3::from([0; 3].map(|_: i32| 100.0 * random.f32() - 50.0));
            if tick > 3 && tick % 7 < 5 {
                frame = frame.with(0, place);
            }
            if tick > 20 && tick % 5 < 4 {
                frame = frame.with(1, -place);
            }
            round.step(frame);
        }
        let replay = round.replay();
        watch(read_round(&check(&replay))).unwrap();
    }
    let mut unplayed = AnyRound::new(open("classic")).replay();
    assert_eq!(unplayed.ticks(), 0);
    unplayed.game = "0.1.0".into();
    assert!(check(&unplayed).len() < 60);
}

#[test]
fn link_of_a_built_in_level_has_its_name_only() {
    for (id, _) in built_in() {
        let level = open(id);
        let link = level.link().unwrap();
        assert!(link.len() < 50, "{id}: {}", link.len());
        assert_eq!(read_level(&link), *level);
    }
}

#[test]
fn link_keeps_the_assists_of_a_round() {
    let all = BTreeSet::from([Assist::WiderBasket, Assist::Unbreakable]);
    for level in [
        open("classic"),
        changed("classic", "drag = 1.0", "drag = 0.9"),
    ] {
        let easy = Arc::new(level.assisted(&all).unwrap());
        let replay = played(&easy, BotKind::Squeeze, 1, 61);
        let read = read_round(&check(&replay));
        assert!(read.is_of(&easy) && !read.is_of(&level));
        assert_eq!(read.level().unwrap().game().assists, all);
        watch(read).unwrap();
    }
}

#[test]
fn link_contains_a_custom_level() {
    let level = changed("classic", "drag = 1.0", "drag = 0.9");
    let link = level.link().unwrap();
    println!("custom level: {} characters", link.len());
    assert!(link.len() < USUAL);
    let read = read_level(&link);
    assert_eq!(
        (read.id.as_str(), read.scene()),
        ("mine.toml", level.scene())
    );
    let replay = played(&level, BotKind::Squeeze, 1, 130);
    watch(read_round(&check(&replay))).unwrap();

    // A custom level with the name of a built-in level. Its link must not give the built-in level.
    let mut other = (*level).clone();
    other.id = "classic".into();
    let read = read_level(&other.link().unwrap());
    assert_eq!(
        (read.id.as_str(), read.scene()),
        ("classic.toml", other.scene())
    );
}

#[test]
fn link_contains_pictures_and_models_that_fit() {
    let nothing = |_: &str| Err(std::io::ErrorKind::NotFound.into());
    let made_of = |id: &str, bytes: &[u8]| Level::read(id, bytes, &nothing).unwrap();
    for level in [
        made_of("a/tom.png", include_bytes!("../../levels/cat.png")),
        made_of("b\\tom.vox", include_bytes!("../../levels/pudding.vox")),
    ] {
        let link = level.link().unwrap();
        println!("{}: {} characters", level.id, link.len());
        assert_eq!(read_level(&link).scene(), level.scene());
        assert_eq!(read_level(&link).id, "tom.toml");
    }

    // A picture of noise cannot be compressed, so its link must be too long.
    let (_, classic) = NAMED[0];
    let text = classic.replace("shape = \"ball\"", "file = \"noise.png\"\nplain = true");
    let level = Level::read("noise.toml", text.as_bytes(), &|_| Ok(noise()));
    let level = Arc::new(level.unwrap());
    let replay = played(&level, BotKind::Idle, 1, 1);
    for refused in [level.link(), replay.link()] {
        let Err(LinkError::TooLong { found }) = refused else {
            panic!("{refused:?}");
        };
        assert!(found > MAX_LENGTH, "{found}");
    }
}

/// Returns a picture of random pixels, as a PNG file.
fn noise() -> Vec<u8> {
    const SIDE: u32 = 128;
    let mut random = Rng::with_seed(1);
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, SIDE, SIDE);
    encoder.set_color(png::ColorType::Rgb);
    let pixels: Vec<u8> = (0..3 * SIDE * SIDE).map(|_| random.u8(..128)).collect();
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&pixels).unwrap();
    writer.finish().unwrap();
    bytes
}

#[test]
fn link_is_read_from_an_address_or_its_fragment() {
    let link = open("donut").link().unwrap();
    let at = |page: &str| address(page, &link);
    assert_eq!(
        at("https://example.org/"),
        format!("https://example.org/#{link}")
    );
    assert_eq!(at("https://example.org/#r1old"), at("https://example.org/"));
    let texts = [
        link.clone(),
        format!("#{link}"),
        format!(" \n#{link}\r\n"),
        at("https://example.org/play?language=ja"),
        format!("\t{} ", at("file:///tmp/play.html")),
    ];
    for text in texts {
        assert_eq!(read_level(&text).id, "donut", "{text}");
    }
}

#[test]
fn damaged_links_are_rejected() {
    let classic = open("classic");
    let links = [
        played(&classic, BotKind::Squeeze, 1, 130).link().unwrap(),
        classic.link().unwrap(),
        changed("classic", "drag = 1.0", "drag = 0.9")
            .link()
            .unwrap(),
    ];
    let other = |letter: u8| if letter == b'A' { 'B' } else { 'A' };
    for link in &links {
        for at in 0..link.len() {
            let (before, after) = link.split_at(at);
            assert!(Link::read(before).is_err(), "cut at {at}");
            let wrong = format!("{before}{}{}", other(after.as_bytes()[0]), &after[1..]);
            assert!(Link::read(&wrong).is_err(), "changed at {at}");
            let lost = format!("{before}{}", &after[1..]);
            assert!(Link::read(&lost).is_err(), "one lost at {at}");
        }
        for more in ["z", "AAAA"] {
            assert!(Link::read(&format!("{link}{more}")).is_err(), "{more}");
        }
        // A character that no fragment contains ends the link.
        for more in [".", "ü", "🙂z"] {
            assert!(Link::read(&format!("{link}{more}")).is_ok(), "{more}");
        }
    }
}

#[test]
fn invalid_links_give_the_matching_error() {
    let link = open("classic").link().unwrap();
    let long = format!("r1{}z", "A".repeat(MAX_LENGTH));
    for (text, expected) in [
        ("", "not a link"),
        ("#", "not a link"),
        ("https://example.org/play", "not a link"),
        ("https://example.org/#readme", "not a link"),
        ("r", "not a link"),
        ("ü1", "not a link"),
        ("r1", "end of this link is missing"),
        ("r1z", "damaged or incomplete"),
        ("r1💾z", "end of this link is missing"),
        (&link[..link.len() - 1], "end of this link is missing"),
        (&link.replace("l1", "r1"), "damaged or incomplete"),
        (&link.replace("l1", "l2"), "by a newer tamaire"),
        (&long, "expected at most 16000 characters, found 16003"),
    ] {
        let error = Link::read(text).unwrap_err().to_string();
        assert!(error.contains(expected), "{text}: {error}");
    }
}

#[test]
fn playback_of_a_link_detects_a_diverging_round() {
    let replay = played(&open("classic"), BotKind::Squeeze, 1, 130);
    let text = replay.text();
    let lie = |from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        let lie = Replay::read(&text.replacen(from, to, 1)).unwrap();
        let error = watch(read_round(&lie.link().unwrap())).unwrap_err();
        error.to_string()
    };
    let moved = lie("frames = [[-11378, 0, 0]", "frames = [[11378, 0, 0]");
    assert!(moved.contains("another way at second 1"), "{moved}");
    let first = &replay.hashes[0][12..];
    let hash = lie(&format!("{first}\""), "0123\"");
    assert!(hash.contains("another way at second 1"), "{hash}");
    let outcome = "\n[outcome]\nticks = 130\nroute = \"mix\"\nkept = 1.0\ninside = 1.0\npieces = 1\nlost = 0\n\n[scene]";
    let won = lie("\n[scene]", outcome);
    assert!(
        won.contains("result differs from the recorded one"),
        "{won}"
    );
}

#[test]
fn round_from_a_link_can_be_stored() {
    let replay = played(&open("classic"), BotKind::Squeeze, 1, 130);
    let read = read_round(&replay.link().unwrap());
    assert_eq!(read.hashes[0], replay.hashes[0][12..]);
    let kept = Replay::read(&read.text_to_keep().unwrap()).unwrap();
    assert_eq!(kept, read);
    assert_eq!(kept.link().unwrap(), replay.link().unwrap());
    watch(kept).unwrap();
}

#[test]
fn link_of_an_unreadable_replay_is_rejected() {
    let text = played(&open("classic"), BotKind::Idle, 1, 61).text();
    let refused = |from: &str, to: &str| {
        let replay = Replay::read(&text.replacen(from, to, 1)).unwrap();
        replay.link().unwrap_err().to_string()
    };
    let level = refused("drag = 1.0", "drag = 0.5");
    assert!(
        level.contains("level in this replay was changed"),
        "{level}"
    );
    let game = format!("game = \"{}", "z".repeat(MAX_LENGTH));
    let long = refused("game = \"", &game);
    assert!(long.contains("at most 16000 characters"), "{long}");
    let hash = Replay::read(&text.replacen("hashes = [\"", "hashes = [\"g", 1));
    let hash = hash.unwrap_err().to_string();
    assert!(
        hash.contains("hash 0: expected 4 to 16 hexadecimal"),
        "{hash}"
    );
}

#[test]
fn round_too_long_for_a_link_can_be_stored_as_fragment() {
    let mut round = AnyRound::new(Arc::new(Level::open("classic").unwrap()));
    let mut random = fastrand::Rng::with_seed(1);
    for _ in 0..3000 {
        let places = [0, 1].map(|_| 4.0 * random.f32() - 2.0);
        round.step(InputFrame::towards(Vec3::new(places[0], places[1], 0.0)));
    }
    let replay = round.replay();
    let long = replay.fragment().unwrap();
    assert!(
        matches!(replay.link(), Err(LinkError::TooLong { .. })),
        "{}",
        long.len()
    );
    assert!(matches!(Link::read(&long), Err(LinkError::TooLong { .. })));
    let kept = Replay::of_fragment(&long).unwrap();
    assert_eq!(
        (kept.ticks(), kept.outcome),
        (replay.ticks(), replay.outcome)
    );
    assert!(matches!(
        Replay::of_fragment(&long[..99]),
        Err(LinkError::CutShort)
    ));
}

#[test]
fn code_in_digits_restores_the_same_round_as_the_link() {
    let mut round = AnyRound::new(Arc::new(Level::open("classic").unwrap()));
    for tick in 0..120 {
        round.step(InputFrame::towards(Vec3::new(0.01 * tick as f32, 0.2, 0.0)));
    }
    let replay = round.replay();
    let code = replay.code().unwrap();
    assert!(
        code[2..code.len() - 1]
            .bytes()
            .all(|byte| byte.is_ascii_digit()),
        "{code}"
    );
    let Ok(Link::Round(read)) = Link::read(&address("https://example.org/", &code)) else {
        panic!("{code}");
    };
    let Ok(Link::Round(linked)) = Link::read(&replay.link().unwrap()) else {
        panic!("expected a link to a round");
    };
    assert_eq!(read, linked);
    assert!(matches!(Link::read(&code[..30]), Err(LinkError::CutShort)));
    assert!(matches!(
        Link::read(&code.replacen('5', "6", 1)),
        Err(LinkError::Damaged)
    ));
}
