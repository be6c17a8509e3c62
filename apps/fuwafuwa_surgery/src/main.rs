//! The program `fuwafuwa_surgery`.

use clap::Parser;
use fuwafuwa_scan::{Label, Options, RESOLUTIONS, Segmentation, Threshold};
use fuwafuwa_surgery::app::devices::Devices;
use fuwafuwa_surgery::app::{App, Setup, wanted};
use fuwafuwa_surgery::headless;
use fuwafuwa_surgery::loading::Wanted;
use std::path::PathBuf;
use std::process::ExitCode;
use tamaire::desktop::window::{Opened, has_display, open};

/// Cut a soft organ, made from a scan or made up, and feel the knife. This is no medical device.
#[derive(Parser)]
#[command(name = "fuwafuwa_surgery", version, after_help = AFTER_HELP)]
struct Arguments {
    /// Scans (NIfTI, .nii or .nii.gz), without thresholds and labels a map for each material, or a recording (.fuwacut)
    files: Vec<PathBuf>,
    /// Voxels along the longest side, 8 to 256
    #[arg(long, default_value_t = 64)]
    resolution: usize,
    /// Intensities of a material, as in 40:120=1 or, without an end, 120:=2; may be repeated, the first counts
    #[arg(long = "threshold", conflicts_with = "labels")]
    thresholds: Vec<Threshold>,
    /// A label and its material, as in 17=1; may be repeated
    #[arg(long = "label")]
    labels: Vec<Label>,
    /// Leave open what is enclosed, instead of filling it
    #[arg(long)]
    hollow: bool,
    /// Where the window saves recordings, tables and plots
    #[arg(long, default_value = ".", value_name = "FOLDER")]
    out: PathBuf,
    /// No window: a trainee operates by itself, or a recording is played again
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
looks around; 1, 2, 3 take tools; J L, I K, U O turn them, X straightens them; P rests, R begins again, F12 cuts all forces.

Exit status: 0 done; 1 a recording does not come out as it was made, something could not be read or written, or the window
broke down; 2 the arguments make no sense";

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    if !RESOLUTIONS.contains(&arguments.resolution) {
        eprintln!(
            "fuwafuwa_surgery: resolution: expected {RESOLUTIONS:?} voxels, found {}",
            arguments.resolution
        );
        return ExitCode::from(2);
    }
    let mut setup = Setup {
        wanted: Wanted::Phantom(arguments.resolution),
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
            eprintln!(
                "fuwafuwa_surgery: there is no display here, so a trainee operates by itself"
            );
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
        Opened::Closed => ExitCode::SUCCESS,
        Opened::LostGpu => failed("the GPU was lost"),
        Opened::Failed(reason) | Opened::Never(reason) => failed(&reason),
        Opened::Broken(panic) => std::panic::resume_unwind(panic),
    }
}

fn failed(reason: &str) -> ExitCode {
    eprintln!("fuwafuwa_surgery: {reason}");
    ExitCode::FAILURE
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Arguments::command().debug_assert();
    }
}
