//! Packages for Linux. A .deb and an archive that needs no installation contain the same file tree.

use super::files::{compress, put, put_text, settle, tar as archive, text_of};
use super::kit::ReleaseBuild;
use super::programs;
use crate::shell::{Failure, execute, file_error, is_on_path, lacking, output_of, root};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Newest glibc version that a program may require: that of Ubuntu 22.04. Debian 12 has a newer one.
const GLIBC: [u32; 2] = [2, 35];
/// Maintainer of the package. The project has no e-mail address.
const MAINTAINER: &str = "The tamaire developers <tamaire@localhost>";
/// Packages of the libraries that a window loads at run time. They are listed by hand, because the linker
/// does not know these libraries.
const WINDOW: &str = "libx11-6, libx11-xcb1, libxcursor1, libxi6, libxkbcommon0, libxkbcommon-x11-0, libvulkan1 | libegl1";

/// Sizes of the icon that exist as bitmaps.
const ICONS: [(&str, &str); 2] = [("192x192", "icon-192.png"), ("512x512", "icon-512.png")];

/// Builds the file tree of the packages, which is installed below /usr.
pub fn programs(kit: &mut ReleaseBuild) -> Result<(), Failure> {
    if !cfg!(target_os = "linux") {
        return Err(Failure::cannot(
            "packages for Linux can only be built on Linux",
        ));
    }
    let built = programs::build(kit, None)?;
    let tree = kit.stage("linux")?;
    for program in ["tamaire", "fuwafuwa"] {
        let path = built.join(program);
        check_glibc(&path)?;
        programs::put_stripped(kit, &path, &tree.join("bin").join(program), "strip")?;
        let mut manual = Command::new(&path);
        let papers = tree.join("papers");
        manual.arg("manual").arg(&papers);
        execute(&mut manual, "the manual pages could not be written")?;
        sort_papers(&papers, &tree.join("share"), program)?;
    }
    fs::remove_dir_all(tree.join("papers")).map_err(|error| file_error(&tree, &error))?;
    let share = tree.join("share");
    let from = |path: &str| root().join("packaging/linux").join(path);
    put(
        &from("tamaire.desktop"),
        &share.join("applications/tamaire.desktop"),
    )?;
    put(
        &from("tamaire.xml"),
        &share.join("mime/packages/tamaire.xml"),
    )?;
    let icons = share.join("icons/hicolor");
    for kind in ["apps/tamaire", "mimetypes/application-x-tamaire"] {
        for (size, file) in ICONS {
            let picture = root().join("game/tamaire/web").join(file);
            put(&picture, &icons.join(size).join(format!("{kind}.png")))?;
        }
        let drawing = root().join("game/tamaire/web/icon.svg");
        put(
            &drawing,
            &icons.join("scalable").join(format!("{kind}.svg")),
        )?;
    }
    let papers = share.join("doc/tamaire");
    for file in ["LICENSE-MIT", "LICENSE-APACHE", "CHANGELOG.md"] {
        put(&root().join(file), &papers.join(file))?;
    }
    put(
        &programs::licences(kit, &programs::host()?)?,
        &papers.join("licences.txt"),
    )?;
    for file in ["exhibit.md", "exhibit.ja.md"] {
        // The pictures of the document stay in the repository.
        let text = text_of(&format!("docs/{file}"))?;
        let lines = text.lines().filter(|line| !line.starts_with("!["));
        put_text(
            &(lines.collect::<Vec<_>>().join("\n") + "\n"),
            &papers.join(file),
        )?;
    }
    let unit = text_of("docs/exhibit/tamaire-stand.service")?;
    put_text(&unit, &papers.join("examples/tamaire-stand.service"))?;
    settle(kit, &tree)?;
    kit.add(tree);
    Ok(())
}

/// Copies manual pages and completions to the folders in which shells and `man` search.
fn sort_papers(papers: &Path, share: &Path, program: &str) -> Result<(), Failure> {
    let pages = papers.join("man");
    let entries = fs::read_dir(&pages).map_err(|error| file_error(&pages, &error))?;
    for page in entries.flatten().map(|entry| entry.path()) {
        let name = page.file_name().unwrap_or_default();
        put(&page, &share.join("man/man1").join(name))?;
    }
    let completions = papers.join("completions");
    for (from, to) in [
        (
            format!("{program}.bash"),
            format!("bash-completion/completions/{program}"),
        ),
        (
            format!("{program}.fish"),
            format!("fish/vendor_completions.d/{program}.fish"),
        ),
        (
            format!("_{program}"),
            format!("zsh/vendor-completions/_{program}"),
        ),
    ] {
        put(&completions.join(from), &share.join(to))?;
    }
    Ok(())
}

/// Builds an archive that runs without installation.
pub fn tar(kit: &mut ReleaseBuild) -> Result<(), Failure> {
    let tree = kit.staged("linux", "linux")?;
    let stage = kit.stage("tar")?;
    let name = format!("tamaire-{}-linux-{}", kit.version, std::env::consts::ARCH);
    copy_tree(&tree, &stage.join(&name))?;
    put(
        &root().join("packaging/linux/README.txt"),
        &stage.join(&name).join("README.txt"),
    )?;
    archive(kit, &stage, &name)
}

/// Builds a package for Debian and Ubuntu.
pub fn deb(kit: &mut ReleaseBuild) -> Result<(), Failure> {
    let tree = kit.staged("linux", "linux")?;
    for program in ["dpkg-deb", "dpkg-shlibdeps", "dpkg"] {
        if !is_on_path(program) {
            return Err(lacking(program, "Debian: dpkg-dev"));
        }
    }
    let architecture = output_of("dpkg", &["--print-architecture"]).unwrap_or_default();
    let architecture = architecture.trim();
    let stage = kit.stage("deb")?;
    let package = stage.join("package");
    copy_tree(&tree, &package.join("usr"))?;
    let papers = package.join("usr/share/doc/tamaire");
    for file in ["LICENSE-MIT", "LICENSE-APACHE"] {
        let path = papers.join(file);
        fs::remove_file(&path).map_err(|error| file_error(&path, &error))?;
    }
    let copyright = text_of("packaging/linux/copyright")?;
    put_text(&copyright, &papers.join("copyright"))?;
    let (changes, changelog) = (papers.join("CHANGELOG.md"), papers.join("changelog"));
    fs::rename(&changes, &changelog).map_err(|error| file_error(&changes, &error))?;
    let pages = package.join("usr/share/man/man1");
    let entries = fs::read_dir(&pages).map_err(|error| file_error(&pages, &error))?;
    let pages = entries.flatten().map(|entry| entry.path());
    let others = [changelog, papers.join("licences.txt")];
    compress(&pages.chain(others).collect::<Vec<_>>())?;
    let unit = papers.join("examples/tamaire-stand.service");
    let text = fs::read_to_string(&unit).map_err(|error| file_error(&unit, &error))?;
    put_text(&text.replace("/usr/local/bin/", "/usr/bin/"), &unit)?;
    let linked = linked_packages(&stage, &package)?;
    let control = control(&kit.version, architecture, &linked, kilobytes(&package)?);
    put_text(&control, &package.join("DEBIAN/control"))?;
    settle(kit, &package)?;
    let file = kit
        .folder()
        .join(format!("tamaire_{}_{architecture}.deb", kit.version));
    let mut build = Command::new("dpkg-deb");
    build.args(["--root-owner-group", "-Zxz", "-z9", "--build"]);
    build
        .arg(&package)
        .arg(&file)
        .env("SOURCE_DATE_EPOCH", &kit.epoch);
    execute(&mut build, "the package could not be built")?;
    kit.add(file);
    Ok(())
}

/// Returns the control file of the Debian package.
fn control(version: &str, architecture: &str, linked: &str, kilobytes: u64) -> String {
    format!(
        "Package: tamaire\n\
         Version: {version}\n\
         Architecture: {architecture}\n\
         Maintainer: {MAINTAINER}\n\
         Installed-Size: {kilobytes}\n\
         Depends: {linked}, {WINDOW}\n\
         Recommends: mesa-vulkan-drivers\n\
         Suggests: xdg-desktop-portal, xserver-xorg, xinit\n\
         Section: games\n\
         Priority: optional\n\
         Description: push a soft, collapsing body into a basket too small for it\n \
         A game about a soft body and a basket that is too small for it: push it in\n \
         whole, or tear bits off until it fits. In 2D and 3D, for one or\n \
         two players, with mouse, keys, touch, gamepads, and force feedback joysticks.\n \
         .\n \
         It includes fuwafuwa, the command-line program of its engine, which draws,\n \
         measures and films soft bodies that squash, tear and crumble.\n"
    )
}

/// Returns the packages with the libraries that the programs are linked to, as found by dpkg-shlibdeps.
fn linked_packages(stage: &Path, package: &Path) -> Result<String, Failure> {
    // dpkg-shlibdeps requires the control file of a source package.
    put_text(
        "Source: tamaire\n\nPackage: tamaire\nArchitecture: any\n",
        &stage.join("debian/control"),
    )?;
    let mut find = Command::new("dpkg-shlibdeps");
    find.arg("-O").current_dir(stage);
    for program in ["tamaire", "fuwafuwa"] {
        find.arg(package.join("usr/bin").join(program));
    }
    let output = find
        .output()
        .map_err(|error| file_error(Path::new("dpkg-shlibdeps"), &error))?;
    let text = String::from_utf8_lossy(&output.stdout);
    match text.trim().strip_prefix("shlibs:Depends=") {
        Some(packages) if output.status.success() => Ok(packages.to_string()),
        _ => Err(Failure::failed(format!(
            "dpkg-shlibdeps: {}",
            String::from_utf8_lossy(&output.stderr)
        ))),
    }
}

/// Size on disk [KiB] as Debian counts it, each file rounded up.
fn kilobytes(folder: &Path) -> Result<u64, Failure> {
    let entries = fs::read_dir(folder).map_err(|error| file_error(folder, &error))?;
    entries.flatten().try_fold(1, |sum, entry| {
        let path = entry.path();
        let data = entry
            .metadata()
            .map_err(|error| file_error(&path, &error))?;
        Ok(sum
            + if data.is_dir() {
                kilobytes(&path)?
            } else {
                data.len().div_ceil(1024)
            })
    })
}

fn copy_tree(from: &Path, to: &PathBuf) -> Result<(), Failure> {
    let parent = to.parent().unwrap_or(to);
    fs::create_dir_all(parent).map_err(|error| file_error(parent, &error))?;
    let mut copy = Command::new("cp");
    copy.arg("-r").arg(from).arg(to);
    execute(&mut copy, "the tree could not be copied")
}

/// Refuses a program that requires a newer glibc than the target systems have.
fn check_glibc(program: &Path) -> Result<(), Failure> {
    let Some(table) = output_of("objdump", &["-T", &program.display().to_string()]) else {
        return Err(lacking("objdump", "Debian: binutils"));
    };
    let newest = newest_glibc(&table);
    let asks = format!("{} requires glibc {newest:?}", program.display());
    eprintln!("xtask: {asks}");
    match newest {
        Some(newest) if newest <= GLIBC => Ok(()),
        _ => Err(Failure::failed(format!(
            "{asks}, but the oldest supported system has {GLIBC:?}: build on Debian 12 or Ubuntu 22.04"
        ))),
    }
}

/// Returns the newest glibc version in a symbol table.
fn newest_glibc(table: &str) -> Option<[u32; 2]> {
    let versions = table.split("GLIBC_").skip(1).filter_map(|rest| {
        let end = rest.find(|letter: char| !letter.is_ascii_digit() && letter != '.');
        let mut parts = rest[..end.unwrap_or(rest.len())].split('.');
        Some([parts.next()?.parse().ok()?, parts.next()?.parse().ok()?])
    });
    versions.max()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn newest_glibc_compares_by_number() {
        let table = "0 DF *UND* 0 (GLIBC_2.2.5) free\n0 DF *UND* 0 (GLIBC_2.34) pow\n0 DF *UND* 0 (GLIBC_2.9) x\n0 DF (GCC_3.0) y\n";
        assert_eq!(newest_glibc(table), Some([2, 34]));
        assert_eq!(newest_glibc("none"), None);
    }

    /// Reads the desktop entry and the MIME types as a desktop does.
    #[test]
    fn desktop_entry_and_mime_type_match() {
        let entry = text_of("packaging/linux/tamaire.desktop").ok().unwrap();
        assert!(entry.starts_with("[Desktop Entry]\n"));
        let value = |key: &str| {
            entry
                .lines()
                .find_map(|line| line.strip_prefix(key)?.strip_prefix('='))
        };
        assert_eq!(value("Exec"), Some("tamaire %f"));
        assert_eq!(value("Icon"), Some("tamaire"));
        let kinds = value("MimeType").unwrap();
        let types = text_of("packaging/linux/tamaire.xml").ok().unwrap();
        let kind = kinds.split(';').next().unwrap();
        assert!(types.contains(&format!("<mime-type type=\"{kind}\">")));
        assert!(types.contains("<glob pattern=\"*.tamaire\"/>"));
        let game = text_of("game/tamaire/src/desktop/window.rs").ok().unwrap();
        assert!(
            game.contains("const APP: &str = \"tamaire\";"),
            "without it, the window has no icon in a dock"
        );
    }

    #[test]
    fn control_file_has_valid_fields() {
        let text = control("1.2.3", "amd64", "libc6 (>= 2.35)", 40_000);
        assert!(text.contains("\nDepends: libc6 (>= 2.35), libx11-6"));
        let is_field = |line: &str| {
            line.split_once(": ")
                .is_some_and(|(name, _)| !name.contains(' '))
        };
        let mut lines = text.lines();
        assert!(
            lines.all(|line| line.starts_with(' ') || is_field(line)),
            "{text}"
        );
        assert!(text.ends_with('\n'));
    }
}
