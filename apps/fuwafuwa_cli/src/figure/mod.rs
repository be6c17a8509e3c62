//! Figures of the paper, drawn from real bodies of the engine.

mod children;
mod disc;
mod legend;
mod phases;
mod sequence;
mod square;

use anyhow::{Context, Result};
use clap::ValueEnum;
use fuwafuwa_painter::{Painter, Pixmap, film};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Draw the figures of the paper from real bodies of the engine, each as SVG and PNG.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Figure to draw.
    #[arg(value_enum)]
    which: Which,
    /// Folder for the files; created if it does not exist.
    #[arg(long)]
    out: PathBuf,
}

/// Figure to draw.
#[derive(Copy, Clone, Debug, PartialEq, Eq, ValueEnum)]
enum Which {
    /// A graded disc with elements by level, and a ball cut open.
    #[value(name = "1")]
    Levels,
    /// The levels of the look-up table from cells to elements.
    #[value(name = "2")]
    Table,
    /// The phases of remodelling.
    #[value(name = "3")]
    Phases,
    /// The conditions for generating a child element.
    #[value(name = "4")]
    Conditions,
    /// Generated children and rebuilt parents, before and after a release.
    #[value(name = "5")]
    Children,
    /// A cutting sequence in 2D and 3D, also as films.
    #[value(name = "6")]
    Sequence,
    /// All figures.
    All,
}

impl Which {
    fn wants(self, figure: Self) -> bool {
        self == figure || self == Self::All
    }
}

/// Draws the selected figures into a folder and prints the names of the files.
pub fn run(arguments: &Arguments) -> Result<ExitCode> {
    let written = write(arguments.which, &arguments.out)?;
    let names = written.iter().map(|path| format!("{}\n", path.display()));
    output::print(&names.collect::<String>())?;
    Ok(ExitCode::SUCCESS)
}

/// Draws the selected figures into a folder and returns the written files.
fn write(which: Which, folder: &Path) -> Result<Vec<PathBuf>> {
    std::fs::create_dir_all(folder)
        .with_context(|| format!("cannot create the folder {}", folder.display()))?;
    let mut files = Files {
        folder,
        written: Vec::new(),
    };
    if which.wants(Which::Levels) {
        files.figure("figure_1", &disc::elements()?)?;
        files.figure("figure_1_ball", &disc::opened_ball()?)?;
    }
    if which.wants(Which::Table) {
        files.figure("figure_2", &disc::table()?)?;
    }
    if which.wants(Which::Phases) {
        files.figure("figure_3", &phases::phases()?)?;
    }
    if which.wants(Which::Conditions) {
        files.figure("figure_4", &children::conditions()?)?;
    }
    if which.wants(Which::Children) {
        files.figure("figure_5", &children::children()?)?;
    }
    if which.wants(Which::Sequence) {
        let (strip, frames) = sequence::disc()?;
        files.figure("figure_6", &strip)?;
        files.film("figure_6", &frames)?;
        let (strip, frames) = sequence::ball()?;
        files.figure("figure_6_ball", &strip)?;
        files.film("figure_6_ball", &frames)?;
    }
    Ok(files.written)
}

/// Output folder with the files written to it.
struct Files<'a> {
    folder: &'a Path,
    written: Vec<PathBuf>,
}

impl Files<'_> {
    fn figure(&mut self, name: &str, painter: &Painter) -> Result<()> {
        self.write(name, "svg", painter.svg()?.as_bytes())?;
        self.write(name, "png", &painter.png()?)
    }

    fn film(&mut self, name: &str, frames: &[Pixmap]) -> Result<()> {
        self.write(name, "gif", &film::gif(frames, sequence::HUNDREDTHS)?)
    }

    fn write(&mut self, name: &str, extension: &str, bytes: &[u8]) -> Result<()> {
        let path = self.folder.join(name).with_extension(extension);
        output::write(&path, bytes).with_context(|| format!("cannot write {}", path.display()))?;
        self.written.push(path);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn write_creates_non_empty_figures() {
        let folder = tempfile::tempdir().unwrap();
        for which in [
            Which::Table,
            Which::Phases,
            Which::Conditions,
            Which::Children,
        ] {
            let written = write(which, folder.path()).unwrap();
            assert_eq!(written.len(), 2);
            for path in written {
                assert!(std::fs::metadata(&path).unwrap().len() > 1000, "{path:?}");
            }
        }
    }
}
