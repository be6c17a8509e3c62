//! The program `fuwafuwa_surgery`.

use app_shell::window::{WindowOutcome, has_display, open};
use clap::Parser;
use fuwafuwa_scan::{Label, Options, RESOLUTIONS, Segmentation, Threshold};
use fuwafuwa_surgery::app::devices::Devices;
use fuwafuwa_surgery::app::{App, Setup, wanted};
use fuwafuwa_surgery::headless;
use fuwafuwa_surgery::loading::LoadRequest;
use std::path::PathBuf;
use std::process::ExitCode;

/// Cut a soft organ, made from a scan or a phantom, and feel the knife. This is not a medical device.
#[derive(Parser)]
#[command(name = "fuwafuwa_surgery", version, after_help = AFTER_HELP)]
struct Arguments {
    /// Scans (NIfTI, .nii or .nii.gz; without thresholds and labels one map per material), or a recording
    /// (.fuwacut)
    files: Vec<PathBuf>,
    /// Number of voxels along the longest side, 8 to 256
    #[arg(long, default_value_t = 64)]
    resolution: usize,
    /// Intensity range of a material, such as 40:120=1 or, without an upper end, 120:=2; repeatable, the
    /// first match counts
    #[arg(long = "threshold", conflicts_with = "labels")]
    thresholds: Vec<Threshold>,
    /// Label and its material, such as 17=1; repeatable
    #[arg(long = "label")]
    labels: Vec<Label>,
    /// Leave enclosed cavities open instead of filling them
    #[arg(long)]
    hollow: bool,
    /// Folder in which the window saves recordings, tables and plots
    #[arg(long, default_value = ".", value_name = "FOLDER")]
    out: PathBuf,
    /// Run without a window: an automatic trainee operates, or a recording is replayed
    #[arg(long)]
    headless: bool,
    #[command(flatten)]
    alone: headless::Options,
}

const AFTER_HELP: &str = "\
Examples:
  fuwafuwa_surgery
  fuwafuwa_surgery target/scans/*_gm_* target/scans/*_wm_*
  fuwafuwa_surgery --headless --seed 7 --save seven.fuwacut --csv seven.csv --plots seven.svg
  fuwafuwa_surgery --headless seven.fuwacut --bench

In the window: the mouse moves the tool, the wheel raises and lowers it, the left button or space grips, the right button
turns the view; 1, 2, 3 take tools; J L, I K, U O turn them, X straightens them; P pauses, R restarts, F12 switches forces off.

Exit status: 0 success; 1 a replay differs from its recording, a file could not be read or written, or the window failed;
2 invalid arguments";

fn main() -> ExitCode {
    let arguments: Arguments = output::parse();
    if !RESOLUTIONS.contains(&arguments.resolution) {
        output::warn(format_args!(
            "fuwafuwa_surgery: resolution: expected {RESOLUTIONS:?} voxels, found {}",
            arguments.resolution
        ));
        return ExitCode::from(2);
    }
    let mut setup = Setup {
        wanted: LoadRequest::Phantom(arguments.resolution),
        segmentation: Segmentation::chosen(&arguments.thresholds, &arguments.labels),
        options: Options {
            resolution: arguments.resolution,
            fills_holes: !arguments.hollow,
        },
        folder: arguments.out,
    };
    if !arguments.files.is_empty() {
        setup.wanted = wanted(arguments.files, &setup);
    }
    if arguments.headless || !has_display() {
        if !arguments.headless {
            output::warn("fuwafuwa_surgery: no display found; running without a window");
        }
        return match headless::operate(&setup.wanted, &arguments.alone) {
            Ok(()) => ExitCode::SUCCESS,
            Err(reason) => failed(&reason),
        };
    }
    let viewport = egui::ViewportBuilder::default().with_title("fuwafuwa surgery");
    let opened = open("fuwafuwa_surgery", viewport, move |context| {
        let app = App::new(context, setup, Devices::open())?;
        let gpu = app.gpu();
        Ok((Box::new(app), gpu))
    });
    match opened {
        WindowOutcome::Closed => ExitCode::SUCCESS,
        WindowOutcome::LostGpu => failed("the GPU was lost"),
        WindowOutcome::Failed(reason) | WindowOutcome::Never(reason) => failed(&reason),
        WindowOutcome::Broken(panic) => std::panic::resume_unwind(panic),
    }
}

fn failed(reason: &str) -> ExitCode {
    output::warn(format_args!("fuwafuwa_surgery: {reason}"));
    ExitCode::FAILURE
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn command_line_is_consistent() {
        Arguments::command().debug_assert();
    }
}
