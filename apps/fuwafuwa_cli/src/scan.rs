//! Converts medical scans to bodies: prints their contents and writes files that other commands open.

use crate::report::{self, Progress};
use crate::run::{check_folder, write};
use anyhow::{Context, Result};
use fuwafuwa::StiffBodies;
use fuwafuwa_scan::{
    Label, MAX_FILE_BYTES, Options, Organ, PlacementSource, Scan, Segmentation, Threshold, warnings,
};
use fuwafuwa_scenes::disk::read_bytes;
use fuwafuwa_scenes::import::Model;
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Steps of the progress bar for reading each scan; making the organ takes the same number of steps.
const STEPS: u64 = 100;

/// Colours of materials in a model, starting at number 1; they repeat after the last.
const COLOURS: [[u8; 3]; 6] = [
    [214, 158, 150],
    [242, 228, 208],
    [178, 74, 68],
    [236, 204, 120],
    [132, 160, 196],
    [150, 176, 132],
];

/// Convert medical scans (NIfTI, .nii or .nii.gz) to voxels with materials: a single scan by intensities or
/// labels, several scans as probability maps of one material each. This is not a medical device.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Scans; without thresholds and labels, one map per material, number 1 first.
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Number of voxels along the longest side, 8 to 256.
    #[arg(long, default_value_t = 64)]
    resolution: usize,
    /// Intensity range of a material, such as 40:120=1 or, without an upper end, 120:=2; repeatable, the
    /// first match counts.
    #[arg(long = "threshold", conflicts_with = "labels")]
    thresholds: Vec<Threshold>,
    /// Label and its material, such as 17=1; repeatable.
    #[arg(long = "label")]
    labels: Vec<Label>,
    /// Fill enclosed cavities.
    #[arg(long)]
    fill: bool,
    /// Write a model (.vox), or a scene (.toml) for `fuwafuwa run` with its model beside it.
    #[arg(long)]
    out: Option<PathBuf>,
    /// Print JSON instead of a table.
    #[arg(long)]
    json: bool,
}

/// Summary of the imported scans.
#[derive(Debug, Serialize)]
struct Summary {
    scans: Vec<ScanInfo>,
    /// Extent to the right, up and to the back [mm].
    sides: [f64; 3],
    grid: [i32; 3],
    /// Voxel size [mm].
    voxel: f32,
    materials: Vec<Share>,
}

#[derive(Debug, Serialize)]
struct ScanInfo {
    file: String,
    size: [usize; 3],
    /// Voxel spacing [mm].
    spacing: [f64; 3],
    /// Header field that gives the position in the patient.
    placed_by: &'static str,
    lowest: f32,
    highest: f32,
    /// Notes on replaced or ignored parts of the file.
    notes: Vec<String>,
}

#[derive(Debug, Serialize)]
struct Share {
    material: u8,
    voxels: usize,
    millilitres: f64,
}

/// Reads the scans, prints a summary, and writes the requested files.
pub fn run(arguments: &Arguments) -> Result<ExitCode> {
    let out = arguments.out.as_deref();
    if let Some(out) = out {
        if is_scene(out)? && out.file_name().is_some_and(|name| name.to_str().is_none()) {
            // A scene names its model.
            anyhow::bail!("{}: expected a name in UTF-8 for a scene", out.display());
        }
        check_folder(out)?;
    }
    let progress = Progress::new();
    progress.expect(STEPS * (arguments.files.len() as u64 + 1));
    let mut scans = Vec::new();
    for path in &arguments.files {
        let name = path.display().to_string();
        let bytes = read_bytes(path, MAX_FILE_BYTES).with_context(|| name.clone())?;
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
    let names = summary.scans.iter().map(|scan| scan.file.as_str());
    let named: Vec<_> = names.zip(&scans).collect();
    for warning in warnings(&named, &segmentation) {
        output::warn(format_args!("warning: {warning}"));
    }
    if let Some(out) = out {
        write_files(out, &organ, &summary)?;
    }
    if arguments.json {
        report::print_json(&summary)?;
    } else {
        output::print(&text(&summary))?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Returns a callback for the progress of reading a scan or making the organ, 0 to 1. The callback advances
/// the bar by up to [`STEPS`] steps.
fn follow(progress: &Progress) -> impl FnMut(f32) {
    let mut shown = 0;
    move |done| {
        while shown < (done * STEPS as f32) as u64 {
            progress.step();
            shown += 1;
        }
        progress.show_if_slow();
    }
}

fn summary(arguments: &Arguments, scans: &[Scan], organ: &Organ) -> Summary {
    let found = arguments
        .files
        .iter()
        .zip(scans)
        .map(|(path, scan)| ScanInfo {
            file: path.display().to_string(),
            size: scan.size(),
            spacing: scan.placement().spacing(),
            placed_by: match scan.placement().source() {
                PlacementSource::Matrix => "sform",
                PlacementSource::Rotation => "qform",
                PlacementSource::Spacing => "pixdim",
            },
            lowest: scan.range()[0],
            highest: scan.range()[1],
            notes: scan.notes().to_vec(),
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
        _ => anyhow::bail!("{}: expected a name ending in .vox or .toml", out.display()),
    }
}

fn write_files(out: &Path, organ: &Organ, summary: &Summary) -> Result<()> {
    let model = out.with_extension("vox");
    let name = model.file_name().unwrap_or_default().to_string_lossy();
    let colours: Vec<_> = COLOURS.into_iter().cycle().take(255).collect();
    let made = Model::of(&name, &organ.grid, &colours)?;
    let bytes = made.bytes();
    if !is_scene(out)? {
        return write(&model, &bytes);
    }
    let scene = scene(&name, made.size(), summary)?;
    output::write_together(&[(&model, &bytes), (out, scene.as_bytes())])
        .map_err(|(path, error)| anyhow::anyhow!("{}: {error}", path.display()))?;
    for path in [&model, out] {
        output::warn(path.display());
    }
    Ok(())
}

/// Scene in which an organ falls onto a table. The fields are those of a scene file.
#[derive(Serialize)]
struct OrganScene<'a> {
    dim: u8,
    stiff_bodies: StiffBodies,
    seconds: f32,
    view: [[f32; 3]; 2],
    material: Vec<OrganMaterial>,
    body: [OrganBody<'a>; 1],
    obstacle: [OrganTable; 1],
}

#[derive(Clone, Serialize)]
struct OrganMaterial {
    young: f32,
    poisson: f32,
    density: f32,
    strength: f32,
    toughness: f32,
}

#[derive(Serialize)]
struct OrganBody<'a> {
    file: &'a str,
    width: f32,
    at: [f32; 3],
}

#[derive(Serialize)]
struct OrganTable {
    friction: f32,
    half_space: HalfSpace,
}

#[derive(Serialize)]
struct HalfSpace {
    normal: [f32; 3],
    point: [f32; 3],
}

/// Returns the TOML text of a scene in which the organ, in real size, falls onto a table 1 cm below.
fn scene(model: &str, size: [usize; 3], summary: &Summary) -> Result<String> {
    let last = summary.materials.last().map_or(1, |share| share.material);
    let sides = size.map(|k| k as f32 * summary.voxel / 1000.0);
    let longest = sides.into_iter().fold(0.0, f32::max);
    let around = 0.6 * longest;
    let material = OrganMaterial {
        young: 20_000.0,
        poisson: 0.4,
        density: 1050.0,
        strength: 50_000.0,
        toughness: 5000.0,
    };
    let scene = OrganScene {
        dim: 3,
        stiff_bodies: StiffBodies::Exact,
        seconds: 2.0,
        view: [-around, around].map(|far| sides.map(|side| 0.5 * side + far)),
        material: vec![material; last.into()],
        body: [OrganBody {
            file: model,
            width: longest,
            at: [0.0, 0.01, 0.0],
        }],
        obstacle: [OrganTable {
            friction: 0.5,
            half_space: HalfSpace {
                normal: [0.0, 1.0, 0.0],
                point: [0.0; 3],
            },
        }],
    };
    Ok(format!(
        "# Made by `fuwafuwa scan`. This is not a medical device.\n\
         # The materials are numbered from 1. All are as soft and dense as organs, hard to tear, and equal until edited.\n\
         \n{}",
        toml::to_string(&scene)?
    ))
}

#[cfg(test)]
#[path = "../tests/sample/mod.rs"]
mod sample;

#[cfg(test)]
mod tests {
    use super::sample::cube;
    use super::*;
    use fuwafuwa::Dim3;
    use fuwafuwa_scenes::disk::open_scene;

    fn scan_to(file: PathBuf, out: PathBuf) -> Result<ExitCode> {
        run(&Arguments {
            files: vec![file],
            resolution: 11,
            thresholds: Vec::new(),
            labels: vec!["1=2".parse().unwrap()],
            fill: false,
            out: Some(out),
            json: false,
        })
    }

    #[test]
    fn scan_converts_to_a_scene_that_builds() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("cube.nii");
        std::fs::write(&file, cube()).unwrap();
        // Names with characters that TOML escapes, or that Rust would escape in another way.
        let names = [
            "cube",
            "脳\u{3000}断面",
            "a \"b\" 'c'",
            "back\\slash",
            "tab\tand\nline",
            "\u{7f}",
            "#1 [x]",
        ];
        for name in names.into_iter().filter(|_| !cfg!(windows)).chain(["cube"]) {
            let out = folder.path().join(format!("{name}.toml"));
            scan_to(file.clone(), out.clone()).unwrap();
            let scene = open_scene(&out.display().to_string(), &[]).unwrap();
            let world = scene.build::<Dim3>().unwrap();
            let (_, body) = world.soft_bodies().next().expect("the scene has a body");
            let grid = body.grid();
            assert_eq!(grid.solid_count(), 729, "{name}");
            assert_eq!(grid.material([5; 3]), 2);
            assert!((grid.voxel_size() - 0.002).abs() < 1e-6);
        }
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn name_that_is_not_utf8_is_refused_before_anything_is_written() {
        use std::ffi::OsStr;
        use std::os::unix::ffi::OsStrExt;
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("cube.nii");
        std::fs::write(&file, cube()).unwrap();
        let out = folder.path().join(OsStr::from_bytes(b"\xff.toml"));
        let error = scan_to(file, out).unwrap_err().to_string();
        assert!(error.contains("expected a name in UTF-8"), "{error}");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }
}
