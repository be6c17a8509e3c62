//! Tests of force feedback against a real Linux kernel in a virtual machine. They check which commands a
//! device driver receives. They also check that no command follows after a process dies or hangs.
//!
//! The machine is QEMU without hardware acceleration, because acceleration is not available everywhere. Its
//! kernel is that of Debian or Ubuntu. Kernel and busybox are unpacked in the target folder and not
//! installed; busybox starts the test.

use crate::packages::{
    self, IfMissing, MissingItem, Purpose, apt_get, install_arguments, list_lacks,
};
use crate::shell::{Failure, answers, cargo, execute, output_of, root, show, target};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

const QEMU: &str = "qemu-system-x86_64";
/// Packages of Debian and Ubuntu that depend on the package of the latest kernel.
const LATEST: [&str; 2] = ["linux-image-amd64", "linux-image-virtual"];
const BUSYBOX: &str = "busybox-static";
/// Script that downloads a package and extracts the named files without their folders.
const FETCH: &str = r#"
    package=$1; shift
    apt-get download --quiet "$package" &&
        dpkg-deb --fsys-tarfile "$package"_*.deb | tar -x --wildcards --transform 's,.*/,,' "$@"
    rm -f "$package"_*.deb
"#;
/// Library for udev. An SDL built with udev gives no force feedback without this library, even though no udev
/// daemon runs in the virtual machine.
const UDEV: &str = "/lib/x86_64-linux-gnu/libudev.so.1";
/// Time limit for a run of the virtual machine [s]; a run usually takes a minute or two.
const PATIENCE: &str = "400";

/// Builds the tests and runs them in the machine; fails if a test fails.
pub fn run(if_missing: IfMissing) -> Result<(), Failure> {
    let folder = root().join(target()).join("kernel");
    let mut found = find_guest(&folder);
    if if_missing == IfMissing::Install
        && let Err(lacks) = &found
    {
        // Updates the package lists, which are old or missing on fresh machines. If the update fails, the old
        // lists may still suffice.
        apt_get(&["update", "--quiet"]);
        lacks.iter().for_each(|lack| provide(&folder, lack));
        found = find_guest(&folder);
    }
    let guest = found.map_err(|lacks| cannot(&lacks, if_missing))?;
    packages::provide(&[Purpose::Build], if_missing);
    let test = build()?;
    pack(&folder, &guest, &test).map_err(|error| {
        Failure::failed(format!(
            "the RAM disk of the machine could not be packed: {error}"
        ))
    })?;
    boot(&folder, &guest.kernel)
}

/// Contents of the virtual machine except for the test.
struct Guest {
    kernel: PathBuf,
    /// Kernel modules to load. Empty if the kernel contains them, as Ubuntu's does.
    modules: Vec<PathBuf>,
    busybox: PathBuf,
}

/// Returns the contents of the virtual machine, or all items that are missing.
fn find_guest(folder: &Path) -> Result<Guest, Vec<MissingItem>> {
    let mut lacks = Vec::new();
    if !answers(QEMU) {
        lacks.push(MissingItem::new(
            format!("{QEMU} not found on the path"),
            "qemu-system-x86",
        ));
    }
    let mut find = |name: &str, package: &str| {
        let found = files(folder, name).pop();
        if found.is_none() {
            let what = format!("{name} not found in {}", folder.display());
            lacks.push(MissingItem::new(what, package));
        }
        found.unwrap_or_default()
    };
    let guest = Guest {
        kernel: find("vmlinuz", LATEST[0]),
        busybox: find("busybox", BUSYBOX),
        modules: ["evdev.ko", "uinput.ko"]
            .iter()
            .flat_map(|name| files(folder, name))
            .collect(),
    };
    if lacks.is_empty() {
        Ok(guest)
    } else {
        Err(lacks)
    }
}

/// Returns the files in a folder whose name begins with `name`.
fn files(folder: &Path, name: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    entries
        .filter(|entry| entry.file_name().to_string_lossy().starts_with(name))
        .map(|entry| entry.path())
        .filter(|path| path.is_file())
        .collect()
}

/// Provides a missing item: installs QEMU, or downloads any other item. Failures are only reported.
fn provide(folder: &Path, lack: &MissingItem) {
    match lack.package.as_str() {
        BUSYBOX => fetch(folder, BUSYBOX, &["*/bin/busybox"]),
        package if package == LATEST[0] => match LATEST.iter().find_map(|name| kernel_of(name)) {
            Some(kernel) => fetch(
                folder,
                &kernel,
                &["*/vmlinuz-*", "*/evdev.ko*", "*/uinput.ko*"],
            ),
            None => eprintln!("xtask: apt has no package {}", LATEST.join(" or ")),
        },
        package => {
            apt_get(&install_arguments([package].into_iter()));
        }
    }
}

/// Returns the kernel package that the package `latest` depends on.
fn kernel_of(latest: &str) -> Option<String> {
    named_kernel(&output_of("apt-cache", &["depends", latest])?)
}

fn named_kernel(depends: &str) -> Option<String> {
    let mut names = depends
        .lines()
        .filter_map(|line| line.trim().strip_prefix("Depends: "));
    names
        .find(|name| name.starts_with("linux-image-"))
        .map(str::to_string)
}

fn fetch(folder: &Path, package: &str, files: &[&str]) {
    let outcome = fs::create_dir_all(folder).map_err(|error| error.to_string());
    let outcome = outcome.and_then(|()| {
        eprintln!("xtask: downloading {package}");
        let mut shell = Command::new("sh");
        shell.args(["-c", FETCH, "fetch", package]).args(files);
        shell
            .current_dir(folder)
            .status()
            .map_err(|error| error.to_string())
    });
    if let Err(error) = outcome {
        eprintln!("xtask: {error}");
    }
}

/// Builds the test and returns its path.
fn build() -> Result<PathBuf, Failure> {
    let mut command = cargo();
    command
        .args("test --package sticks --features haptic --test kernel".split(' '))
        .args("--no-run --message-format json-render-diagnostics".split(' '));
    eprintln!("xtask: {}", show(&command));
    let output = command
        .current_dir(root())
        .stderr(Stdio::inherit())
        .output();
    let built = output.ok().filter(|output| output.status.success());
    let test = built.and_then(|output| executable_of(&String::from_utf8_lossy(&output.stdout)));
    test.ok_or_else(|| Failure::failed("the tests could not be built, see above"))
}

/// Returns the last executable in cargo's JSON messages.
fn executable_of(messages: &str) -> Option<PathBuf> {
    let (_, rest) = messages.rsplit_once("\"executable\":\"")?;
    rest.split_once('"').map(|(path, _)| PathBuf::from(path))
}

/// Packs the initial RAM disk of the virtual machine.
fn pack(folder: &Path, guest: &Guest, test: &Path) -> io::Result<()> {
    let disk = folder.join("disk");
    if disk.exists() {
        fs::remove_dir_all(&disk)?;
    }
    for empty in ["bin", "dev", "modules", "proc", "sys", "tmp"] {
        fs::create_dir_all(disk.join(empty))?;
    }
    fs::copy(&guest.busybox, disk.join("bin/busybox"))?;
    fs::copy(root().join("tools/xtask/guest.sh"), disk.join("init"))?;
    fs::copy(test, disk.join("test"))?;
    for module in &guest.modules {
        let name = module
            .file_name()
            .expect("the module was found by its name");
        fs::copy(module, disk.join("modules").join(name))?;
    }
    let ldd = |program: &str| output_of("ldd", &[program]).unwrap_or_default();
    let needed = ldd(&test.to_string_lossy()) + &ldd(UDEV);
    let udev = Some(UDEV).filter(|udev| Path::new(udev).exists());
    for library in libraries(&needed).into_iter().chain(udev) {
        let copy = disk.join(library.trim_start_matches('/'));
        fs::create_dir_all(copy.parent().expect("an absolute path has a parent"))?;
        fs::copy(library, copy)?;
    }
    let cpio = "chmod +x init && find . | bin/busybox cpio -o -H newc >../disk.cpio";
    let status = Command::new("sh")
        .args(["-c", cpio])
        .current_dir(&disk)
        .status()?;
    if status.success() {
        Ok(())
    } else {
        Err(io::Error::other("cpio failed"))
    }
}

/// Returns the paths in the output of ldd.
fn libraries(ldd: &str) -> Vec<&str> {
    let words = ldd.split_whitespace();
    words.filter(|word| word.starts_with('/')).collect()
}

/// Runs the virtual machine until it powers off.
fn boot(folder: &Path, kernel: &Path) -> Result<(), Failure> {
    let status = folder.join("status");
    // Removes the result of an earlier run, which must not be taken for that of this run.
    let _ = fs::remove_file(&status);
    let mut machine = Command::new("timeout");
    machine
        .args(["--foreground", PATIENCE, QEMU])
        .args("-accel tcg -cpu max -smp 2 -m 512 -nodefaults -no-user-config".split(' '))
        .args("-no-reboot -display none -serial stdio".split(' '))
        .args(["-append", "console=ttyS0 quiet panic=-1", "-serial"])
        .arg(format!("file:{}", status.display()))
        .arg("-kernel")
        .arg(kernel)
        .arg("-initrd")
        .arg(folder.join("disk.cpio"))
        .stdin(Stdio::null());
    execute(
        &mut machine,
        "the machine did not finish in time or could not be started",
    )?;
    let said = fs::read_to_string(&status).unwrap_or_default();
    if said.trim() == "0" {
        return Ok(());
    }
    Err(Failure::failed(
        "a test failed in the machine, or the machine stopped before, see above",
    ))
}

fn cannot(lacks: &[MissingItem], if_missing: IfMissing) -> Failure {
    let advice = match if_missing {
        IfMissing::Say => {
            "On Debian and Ubuntu, `cargo xtask kernel --install` installs QEMU and downloads the rest."
        }
        IfMissing::Install => "The packages available from apt are not sufficient, see above.",
    };
    Failure::cannot(format!(
        "force feedback was NOT tested against a kernel:\n{}\n{advice}\n\
             This task requires Linux on x86-64.",
        list_lacks(lacks)
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kernel_package_is_found_in_dependencies() {
        let debian = "linux-image-amd64\n  Depends: linux-image-6.1.0-56-amd64\n";
        let ubuntu = "linux-image-virtual\n  Depends: linux-modules-6.8.0-1\n |Depends: a\n  Depends: linux-image-6.8.0-1-generic\n  Suggests: b\n";
        for (depends, expect) in [
            (debian, Some("linux-image-6.1.0-56-amd64")),
            (ubuntu, Some("linux-image-6.8.0-1-generic")),
            ("linux-image-amd64\n", None),
        ] {
            assert_eq!(named_kernel(depends).as_deref(), expect, "{depends}");
        }
    }

    #[test]
    fn executable_is_last_in_messages() {
        let messages = "{\"executable\":null}\n{\"name\":\"build\",\"executable\":\"/a/b\"}\n\
                        {\"executable\":\"/t/kernel-1\",\"fresh\":true}\n{\"success\":true}\n";
        assert_eq!(executable_of(messages), Some(PathBuf::from("/t/kernel-1")));
        assert_eq!(executable_of("{\"success\":false}"), None);
    }

    #[test]
    fn libraries_are_paths_in_ldd_output() {
        let ldd = "\tlinux-vdso.so.1 (0x7f)\n\tlibm.so.6 => /lib/libm.so.6 (0x7e)\n\t/lib64/ld.so.2 (0x7d)\n";
        assert_eq!(libraries(ldd), ["/lib/libm.so.6", "/lib64/ld.so.2"]);
    }
}
