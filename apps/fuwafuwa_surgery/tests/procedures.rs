//! Procedures without a window stay valid, replay identically, and cut as expected.

use fuwafuwa::{Rotation, Vec3};
use fuwafuwa_surgery::measures::parts;
use fuwafuwa_surgery::phantom;
use fuwafuwa_surgery::procedure::{Input, Procedure};
use fuwafuwa_surgery::record::{Playback, RecordError, Recording};
use fuwafuwa_surgery::report;
use fuwafuwa_surgery::save;
use fuwafuwa_surgery::tools::Tool;
use fuwafuwa_surgery::trainee::Trainee;
use std::sync::Arc;

fn procedure(resolution: usize) -> Procedure {
    Procedure::new(Arc::new(phantom::case(resolution).unwrap())).unwrap()
}

/// Checks that the organ is valid and that the last sample is finite.
fn check(procedure: &Procedure, what: &str) {
    let organ = procedure.organ();
    let valid = organ.mesh().validate(organ.grid(), organ.connectivity());
    valid.unwrap_or_else(|defect| panic!("{what}: {defect}"));
    for view in organ.piece_views() {
        assert!(!view.quarantined, "{what}: a piece is quarantined");
        let numbers = [view.centre, view.velocity, view.low, view.high];
        let is_finite = numbers.iter().all(|vector| vector.is_finite());
        assert!(is_finite || view.element_count == 0, "{what}: {view:?}");
    }
    let sample = procedure.samples().last().unwrap();
    let numbers = [sample.at, sample.force, sample.torque];
    assert!(
        numbers.iter().all(|vector| vector.is_finite()),
        "{what}: {sample:?}"
    );
    assert!(
        sample.peak.is_finite() && sample.work.is_finite(),
        "{what}: {sample:?}"
    );
}

#[test]
fn automatic_trainees_keep_the_organ_valid_and_its_volume() {
    let mut cut = 0.0;
    for seed in 0..20 {
        let mut procedure = procedure(18);
        let trainee = Trainee::new(&procedure, seed);
        for tick in 0..trainee.ticks() {
            procedure.step(trainee.input(tick)).unwrap();
            if tick % 120 == 0 {
                check(&procedure, &format!("seed {seed}, tick {tick}"));
            }
        }
        check(&procedure, &format!("seed {seed}"));
        cut += procedure.samples().last().unwrap().area;
        let whole = procedure.case().grid.solid_count() as f64 * procedure.case().millilitres();
        let parts = parts(procedure.organ(), procedure.case().millilitres());
        let sum: f64 = parts.iter().map(|part| part.millilitres).sum();
        assert!((sum / whole - 1.0).abs() < 1e-9, "{sum} of {whole} ml left");
    }
    assert!(
        cut > 20.0 * 1e-4,
        "expected twenty cuts of some cm² each, found {cut} m² in total"
    );
}

#[test]
fn replay_is_identical_and_detects_changed_input() {
    let mut procedure = procedure(16);
    let trainee = Trainee::new(&procedure, 3);
    for tick in 0..trainee.ticks() {
        procedure.step(trainee.input(tick)).unwrap();
    }
    let recording = Recording::of(&procedure);
    let read = Recording::read(&recording.bytes()).unwrap();
    assert_eq!(read, recording);
    let mut playback = Playback::new(Arc::new(read)).unwrap();
    while !playback.is_over() {
        playback.step().unwrap();
    }
    assert_eq!(
        playback.procedure().world().hash(),
        procedure.world().hash()
    );
    assert_eq!(playback.procedure().samples(), procedure.samples());

    // Lowers the tool in the recorded inputs of the third second. The replay must report the difference
    // within that second.
    let mut other = recording.clone();
    for input in &mut other.inputs[150..160] {
        input.goal[1] -= 700;
    }
    let mut playback = Playback::new(Arc::new(other)).unwrap();
    let wrong = loop {
        if let Err(error) = playback.step() {
            break error;
        }
        assert!(!playback.is_over(), "the difference was not detected");
    };
    assert!(
        matches!(wrong, RecordError::Differs { second: 2 }),
        "{wrong}"
    );
}

/// Moves the tool from its current position along the points `way` at a speed [m/s]. Returns the maximum
/// force on the tool [N].
fn go(procedure: &mut Procedure, input: Input, way: &[Vec3], pace: f32) -> f32 {
    let begun = procedure.samples().len();
    let here = procedure.tool().position();
    let way: Vec<Vec3> = [here].into_iter().chain(way.iter().copied()).collect();
    for pair in way.windows(2) {
        let way = pair[1] - pair[0];
        let ticks = (way.length() / pace * 60.0).ceil().max(1.0) as usize;
        for tick in 1..=ticks {
            let share = tick as f32 / ticks as f32;
            let next = input.at(input.tool, pair[0] + share * way, input.rotation());
            procedure.step(next).unwrap();
        }
    }
    let samples = &procedure.samples()[begun..];
    let forces = samples.iter().map(|sample| sample.force.length());
    forces.fold(0.0, f32::max)
}

fn with(tool: Tool, dull: u16) -> Input {
    let input = Input {
        dull,
        ..Input::default()
    };
    input.at(tool, Vec3::ZERO, Rotation::NONE)
}

#[test]
fn dull_knife_cuts_less_and_presses_more() {
    let (mut felt, mut areas) = (Vec::new(), Vec::new());
    for dull in [20, 800] {
        let mut procedure = procedure(28);
        let input = with(Tool::Knife, dull);
        let way = [
            Vec3::new(-0.03, 0.1, -0.01),
            Vec3::new(-0.03, 0.02, -0.01),
            Vec3::new(0.04, 0.02, -0.01),
        ];
        felt.push(go(&mut procedure, input, &way, 0.06));
        let last = procedure.samples().last().unwrap();
        // The edge is 3 cm long and moves about 3 cm down and 7 cm sideways, so the cut has several cm². A
        // dull edge presses before it cuts.
        areas.push(1e4 * last.area);
        assert!(last.path > 0.03 && last.work > 0.0, "{last:?}");
        check(&procedure, "cut");
    }
    assert!((3.0..30.0).contains(&areas[0]), "{areas:?} cm²");
    assert!(areas[1] < 0.8 * areas[0], "{areas:?} cm²");
    assert!(felt[0] > 0.1 && felt[1] > felt[0], "{felt:?} N");
}

#[test]
fn forceps_hold_and_release_tissue() {
    let mut procedure = procedure(20);
    let input = with(Tool::Forceps, 0);
    let top = procedure.organ().piece_views()[0].high.y;
    let at = |y: f32| Vec3::new(0.02, y, -0.012);
    go(
        &mut procedure,
        input,
        &[at(top + 0.02), at(top - 0.003)],
        0.06,
    );
    assert!(!procedure.held().grips());
    let grips = true;
    let closed = Input { grips, ..input };
    let pulled = go(
        &mut procedure,
        closed,
        &[at(top - 0.003), at(top + 0.015)],
        0.04,
    );
    let raised = procedure.organ().piece_views()[0].high.y - top;
    assert!(procedure.held().grips() && raised > 0.004, "{raised} m");
    assert!(
        procedure.held().pull(procedure.world()) > 0.05,
        "felt {pulled} N"
    );
    go(
        &mut procedure,
        input,
        &[at(top + 0.015), at(top + 0.04)],
        0.04,
    );
    assert!(!procedure.held().grips());
    // Far above the organ there is nothing to grip.
    go(&mut procedure, closed, &[at(top + 0.05)], 0.04);
    assert!(!procedure.held().grips());
}

#[test]
fn hook_feels_contact_force() {
    let mut procedure = procedure(20);
    let top = procedure.organ().piece_views()[0].high.y;
    let way = [top + 0.02, top - 0.015].map(|y| Vec3::new(0.0, y, -0.0154));
    go(&mut procedure, with(Tool::Hook, 0), &way, 0.05);
    let last = procedure.samples().last().unwrap();
    assert!(last.force.y > 0.1, "{:?}", last.force);
    assert_eq!((last.area, last.tool), (0.0, Tool::Hook));
}

#[test]
fn blunt_tools_do_not_slip_between_nodes_of_coarse_organs() {
    for resolution in [20, 28, 36] {
        for tool in [Tool::Forceps, Tool::Hook] {
            let mut procedure = procedure(resolution);
            let top = procedure.organ().piece_views()[0].high.y;
            let way = [top + 0.01, top - 0.012].map(|y| Vec3::new(0.021, y, -0.012));
            go(&mut procedure, with(tool, 0), &way, 0.03);
            let tip = procedure.tool();
            let organ = procedure.organ();
            let places = organ.mesh().nodes().map(|(id, _)| organ.node_state(id).0);
            let over = places.filter(|&place| {
                let away = place - tip.position();
                away.y > 0.002 && away.x.hypot(away.z) < 0.002
            });
            let force = procedure.samples().last().unwrap().force;
            let what = format!("{tool:?} at {resolution} voxels");
            assert_eq!(over.count(), 0, "{what}: nodes are above the pressed tip");
            assert!(force.y > 0.08, "{what}: {force:?} N");
        }
    }
}

#[test]
fn tools_enter_clear_of_the_coarsest_organ() {
    for resolution in [8, 12, 48] {
        for tool in Tool::ALL {
            let mut procedure = procedure(resolution);
            let height = procedure.entry();
            let upright = Rotation::about(Vec3::Z, 1.57);
            let input = Input::default().at(tool, Vec3::new(0.0, height, 0.0), upright);
            for _ in 0..40 {
                procedure.step(input).unwrap();
            }
            let (organ, shape) = (procedure.organ(), procedure.tool().shape());
            let places = organ.mesh().nodes().map(|(id, _)| organ.node_state(id).0);
            let nearest = places.map(|place| shape.distance(place).0);
            let nearest = nearest.fold(f32::MAX, f32::min);
            assert!(
                nearest > 0.0,
                "{tool:?} at {resolution} voxels: {nearest} m"
            );
        }
    }
}

#[test]
fn csv_and_svg_contain_the_measurements() {
    let mut procedure = procedure(12);
    for tick in 0..50 {
        let place = Vec3::new(0.0, 0.1, 0.001 * tick as f32);
        let input = with(Tool::Hook, 0).at(Tool::Hook, place, Rotation::NONE);
        procedure.step(input).unwrap();
    }
    let table = report::csv(procedure.samples());
    let lines: Vec<Vec<&str>> = table
        .lines()
        .map(|line| line.split(',').collect())
        .collect();
    assert_eq!(lines.len(), 51);
    for line in &lines[1..] {
        assert_eq!(line.len(), lines[0].len());
        assert_eq!(line[2], "hook");
        let numbers = line.iter().enumerate().filter(|(column, _)| *column != 2);
        numbers.for_each(|(_, word)| assert!(word.parse::<f64>().is_ok(), "{word}"));
    }
    assert_eq!((lines[50][0], lines[50][1]), ("50", "0.8333"));
    let z: f64 = lines[50][5].parse().unwrap();
    let found = 1000.0 * f64::from(procedure.samples()[49].at.z);
    assert!((z - found).abs() < 1e-3, "{z} {found}");
    let plots = report::svg(procedure.samples()).unwrap();
    assert!(plots.starts_with("<svg") && plots.contains("force on the tool [N]"));
    assert!(plots.contains("Not a medical device"));
    assert!(report::svg(&[]).is_ok());
}

#[test]
fn save_overwrites_no_file() {
    let folder = tempfile::tempdir().unwrap();
    let mut procedure = procedure(8);
    procedure.step(Input::default()).unwrap();
    let names = [1, 2].map(|_| {
        let saved = save::save(folder.path(), &procedure).unwrap();
        saved.file_name().unwrap().to_str().unwrap().to_owned()
    });
    assert_eq!(names, ["procedure-1.fuwacut", "procedure-2.fuwacut"]);
    let bytes = std::fs::read(folder.path().join("procedure-2.fuwacut")).unwrap();
    assert_eq!(Recording::read(&bytes).unwrap().ticks(), 1);
    for name in [
        "procedure-1.csv",
        "procedure-2.csv",
        "procedure-1.svg",
        "procedure-2.svg",
    ] {
        assert!(
            folder.path().join(name).metadata().unwrap().len() > 100,
            "{name}"
        );
    }
    let nowhere = folder.path().join("there is none");
    assert!(
        save::save(&nowhere, &procedure)
            .unwrap_err()
            .contains("there is none")
    );
}
