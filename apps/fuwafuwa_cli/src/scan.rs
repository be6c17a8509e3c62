//! Scans of patients become bodies: what is in them, and files that other commands open.

use crate::report::{self, Progress};
use crate::run::{check_folder, write};
use anyhow::{Context, Result};
use fuwafuwa_scan::{Label, MAX_FILE_BYTES, Options, Organ, Scan, Segmentation, Source, Threshold};
use fuwafuwa_scenes::disk::bytes_of;
use fuwafuwa_scenes::import::Model;
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Steps of the bar for each scan, and for the organ.
const STEPS: u64 = 100;

/// Colours of materials in a model, from number 1 on and again from the beginning.
const COLOURS: [[u8; 3]; 6] = [
    [214, 158, 150],
    [242, 228, 208],
    [178, 74, 68],
    [236, 204, 120],
    [132, 160, 196],
    [150, 176, 132],
];

/// Make voxels with materials of medical scans (NIfTI, .nii or .nii.gz): of one by intensities or labels, of several
/// as maps that say how probable each material is. This is no medical device.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Scans; without thresholds and labels a map for each material, number 1 first.
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Voxels along the longest side, 8 to 256.
    #[arg(long, default_value_t = 64)]
    resolution: usize,
    /// Intensities of a material, as in 40:120=1 or, without an end, 120:=2; may be repeated, the first counts.
    #[arg(long = "threshold", conflicts_with = "labels")]
    thresholds: Vec<Threshold>,
    /// A label and its material, as in 17=1; may be repeated.
    #[arg(long = "label")]
    labels: Vec<Label>,
    /// Fill what is enclosed.
    #[arg(long)]
    fill: bool,
    /// Write a model (.vox), or a scene (.toml) with its model beside it, which `fuwafuwa run` runs.
    #[arg(long)]
    out: Option<PathBuf>,
    /// Print JSON instead of a table.
    #[arg(long)]
    json: bool,
}

/// What came of scans.
#[derive(Debug, Serialize)]
struct Summary {
    scans: Vec<Found>,
    /// To the right, up and to the back [mm].
    sides: [f64; 3],
    grid: [i32; 3],
    /// [mm]
    voxel: f32,
    materials: Vec<Share>,
}

#[derive(Debug, Serialize)]
struct Found {
    file: String,
    size: [usize; 3],
    /// [mm]
    spacing: [f64; 3],
    /// What tells where in the patient it is.
    placed_by: &'static str,
    lowest: f32,
    highest: f32,
}

#[derive(Debug, Serialize)]
struct Share {
    material: u8,
    voxels: usize,
    millilitres: f64,
}

/// Reads the scans, says what is in them, and writes what was asked for.
pub fn run(arguments: &Arguments) -> Result<ExitCode> {
    let out = arguments.out.as_deref();
    if let Some(out) = out {
        is_scene(out)?;
        check_folder(out)?;
    }
    let progress = Progress::new();
    progress.expect(STEPS * (arguments.files.len() as u64 + 1));
    let mut scans = Vec::new();
    for path in &arguments.files {
        let name = path.display().to_string();
        let bytes = bytes_of(path, MAX_FILE_BYTES).with_context(|| name.clone())?;
        scans.push(Scan::decode(&name, &bytes, follow(&progress))?);
    }
    let options = Options {
        resolution: arguments.resolution,
        fills_holes: arguments.fill,
    };
    let all: Vec<&Scan> = scans.iter().collect();
    let segmentation = Segmentation::chosen(&arguments.thresholds, &arguments.labels);
    let organ = Organ::of(&all, &segmentation, &options, follow(&progress))?;
    drop(progress);
    let summary = summary(arguments, &scans, &organ);
    if arguments.json {
        println!("{}", serde_json::to_string_pretty(&summary)?);
    } else {
        print!("{}", text(&summary));
    }
    let is_unplaced = |scan: &Scan| scan.placement().source() == Source::Spacing;
    if scans.iter().any(is_unplaced) {
        eprintln!("warning: a scan does not say what of it is left and what is right");
    }
    if let Some(out) = out {
        write_files(out, &organ, &summary)?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Moves the bar by as many steps as are done of those of one part.
fn follow(progress: &Progress) -> impl FnMut(f32) {
    let mut shown = 0;
    move |done| {
        while shown < (done * STEPS as f32) as u64 {
            progress.step();
            shown += 1;
        }
        progress.look();
    }
}

fn summary(arguments: &Arguments, scans: &[Scan], organ: &Organ) -> Summary {
    let found = arguments.files.iter().zip(scans).map(|(path, scan)| Found {
        file: path.display().to_string(),
        size: scan.size(),
        spacing: scan.placement().spacing(),
        placed_by: match scan.placement().source() {
            Source::Matrix => "sform",
            Source::Rotation => "qform",
            Source::Spacing => "pixdim",
        },
        lowest: scan.range()[0],
        highest: scan.range()[1],
    });
    let shares = (1..=u8::MAX).map(|material| Share {
        material,
        voxels: organ.voxels(material),
        millilitres: organ.millilitres(material),
    });
    Summary {
        scans: found.collect(),
        sides: organ.sides(),
        grid: organ.grid.size(),
        voxel: 1000.0 * organ.grid.voxel_size(),
        materials: shares.filter(|share| share.voxels > 0).collect(),
    }
}

fn text(summary: &Summary) -> String {
    let times = |sides: [f64; 3], digits: usize| {
        let sides = sides.map(|side| format!("{side:.digits$}"));
        sides.join(" x ")
    };
    let mut text = String::new();
    for scan in &summary.scans {
        text += &format!(
            "{}: {} voxels of {} mm, placed by {}, values {} to {}\n",
            scan.file,
            times(scan.size.map(|k| k as f64), 0),
            times(scan.spacing, 2),
            scan.placed_by,
            scan.lowest,
            scan.highest
        );
    }
    text += &format!(
        "{} mm to the right, up and to the back, in {} voxels of {:.2} mm\n",
        times(summary.sides, 0),
        times(summary.grid.map(f64::from), 0),
        summary.voxel
    );
    let mut rows = vec![
        ["material", "voxels", "volume [ml]"]
            .map(String::from)
            .to_vec(),
    ];
    rows.extend(summary.materials.iter().map(|share| {
        vec![
            share.material.to_string(),
            share.voxels.to_string(),
            format!("{:.1}", share.millilitres),
        ]
    }));
    text + &report::table(&rows, &[true; 3])
}

fn is_scene(out: &Path) -> Result<bool> {
    match out.extension().and_then(|end| end.to_str()) {
        Some("vox") => Ok(false),
        Some("toml") => Ok(true),
        _ => anyhow::bail!("{}: expected a name in .vox or .toml", out.display()),
    }
}

fn write_files(out: &Path, organ: &Organ, summary: &Summary) -> Result<()> {
    let model = out.with_extension("vox");
    let name = model.file_name().unwrap_or_default().to_string_lossy();
    let colours: Vec<_> = COLOURS.into_iter().cycle().take(255).collect();
    let bytes = Model::of(&name, &organ.grid, &colours)?.bytes();
    write(&model, &bytes)?;
    if is_scene(out)? {
        write(out, scene(&name, summary).as_bytes())?;
    }
    Ok(())
}

/// The organ, as large as it is, lets itself down on a table a finger's breadth below.
fn scene(model: &str, summary: &Summary) -> String {
    let last = summary.materials.last().map_or(1, |share| share.material);
    let [right, up, back] = summary.grid.map(|k| k as f32 * summary.voxel / 1000.0);
    let longest = right.max(up).max(back);
    let around = 0.6 * longest;
    let mut text = format!(
        "# Made by `fuwafuwa scan`. This is no medical device.\n\
         dim = 3\n\
         seconds = 2.0\n\
         view = [[{:?}, {:?}, {:?}], [{:?}, {:?}, {:?}]]\n\
         \n# All materials are soft and heavy as organs are, hard to tear, and alike until somebody says more.\n",
        0.5 * right - around,
        0.5 * up - around,
        0.5 * back - around,
        0.5 * right + around,
        0.5 * up + around,
        0.5 * back + around,
    );
    for material in 1..=last {
        text += &format!(
            "[[material]] # number {material}\n\
             young = 20000.0\n\
             poisson = 0.4\n\
             density = 1050.0\n\
             strength = 50000.0\n\
             toughness = 5000.0\n\n"
        );
    }
    text + &format!(
        "[[body]]\n\
         file = {model:?}\n\
         width = {longest:?}\n\
         at = [0.0, 0.01, 0.0]\n\
         \n[[obstacle]]\n\
         half_space = {{ normal = [0.0, 1.0, 0.0], point = [0.0, 0.0, 0.0] }}\n\
         friction = 0.5\n"
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use fuwafuwa::Dim3;
    use fuwafuwa_scenes::disk::scene_at;

    /// A cube of nine voxels of 2 mm, and around it nothing; NIfTI-1 as it is laid out.
    fn cube() -> Vec<u8> {
        let mut bytes = vec![0; 352 + 13 * 13 * 13];
        bytes[..4].copy_from_slice(&348_i32.to_le_bytes());
        for (index, number) in [3, 13, 13, 13, 1, 1, 1, 1].into_iter().enumerate() {
            bytes[40 + 2 * index..][..2].copy_from_slice(&i16::to_le_bytes(number));
        }
        bytes[70] = 2;
        bytes[72] = 8;
        bytes[108..112].copy_from_slice(&352_f32.to_le_bytes());
        for axis in 0..3 {
            bytes[80 + 4 * axis..][..4].copy_from_slice(&2_f32.to_le_bytes());
        }
        bytes[344..348].copy_from_slice(b"n+1\0");
        for at in 0..13 * 13 * 13 {
            let is_inside = [at % 13, at / 13 % 13, at / 169]
                .iter()
                .all(|k| (2..11).contains(k));
            bytes[352 + at] = u8::from(is_inside);
        }
        bytes
    }

    #[test]
    fn a_scan_becomes_a_scene_that_can_be_built() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("cube.nii");
        std::fs::write(&file, cube()).unwrap();
        let out = folder.path().join("cube.toml");
        let arguments = Arguments {
            files: vec![file],
            resolution: 11,
            thresholds: Vec::new(),
            labels: vec!["1=2".parse().unwrap()],
            fill: false,
            out: Some(out.clone()),
            json: false,
        };
        run(&arguments).unwrap();
        let scene = scene_at(&out.display().to_string(), &[]).unwrap();
        let world = scene.build::<Dim3>().unwrap();
        let body = world.soft_bodies().iter().next();
        let grid = body.expect("the scene has one").grid();
        assert_eq!(grid.solid_count(), 729);
        assert_eq!(grid.material([5; 3]), 2);
        assert!((grid.voxel_size() - 0.002).abs() < 1e-6);
    }
}
