//! A real PostgreSQL server in its own folder, on a private socket.

use postgres::{Client, NoTls};
use std::env;
use std::fs;
use std::os::unix::fs::{PermissionsExt, chown};
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};
use tamaire_logbook::Server;
use tempfile::TempDir;

/// User id of `nobody`. The server runs as this user if the test runs as root, because PostgreSQL refuses to
/// run as root.
const NOBODY: u32 = 65534;

pub struct Postgres {
    folder: TempDir,
    programs: PathBuf,
    child: Option<Child>,
}

impl Postgres {
    /// Creates a server that is not started yet. Without an installed PostgreSQL, prints a message and
    /// returns `None`.
    pub fn find() -> Option<Self> {
        let Some(programs) = programs() else {
            eprintln!("skipped: no PostgreSQL server is installed (Debian package: postgresql)");
            return None;
        };
        let folder = tempfile::tempdir().unwrap();
        let server = Self {
            folder,
            programs,
            child: None,
        };
        if is_root() {
            let open = fs::Permissions::from_mode(0o755);
            fs::set_permissions(server.folder.path(), open).unwrap();
            chown(server.folder.path(), Some(NOBODY), Some(NOBODY)).unwrap();
        }
        let mut make = server.program("initdb");
        make.args([
            "--no-sync",
            "--auth=trust",
            "--encoding=UTF8",
            "--locale=C",
            "--username=stand",
        ]);
        let made = make.arg("-D").arg(server.data()).output().unwrap();
        assert!(
            made.status.success(),
            "{}",
            String::from_utf8_lossy(&made.stderr)
        );
        Some(server)
    }

    /// Starts the server and waits until it answers.
    pub fn start(&mut self) {
        let start = Instant::now();
        loop {
            let mut serve = self.program("postgres");
            serve
                .arg("-D")
                .arg(self.data())
                .arg("-k")
                .arg(self.folder.path());
            serve.args(["-c", "listen_addresses=", "-c", "max_connections=20"]);
            // The tests kill the server, not the machine: commits need not be flushed.
            serve.args(["-c", "fsync=off", "-c", "shared_buffers=16MB"]);
            let mut child = serve.spawn().unwrap();
            // After a kill, the socket and the shared memory stay in use until all child processes of the old
            // server have ended.
            while child.try_wait().unwrap().is_none() {
                if Client::connect(&self.address("postgres"), NoTls).is_ok() {
                    self.child = Some(child);
                    return;
                }
                thread::sleep(Duration::from_millis(20));
            }
            assert!(
                start.elapsed() < Duration::from_secs(60),
                "the server does not start"
            );
            thread::sleep(Duration::from_millis(50));
        }
    }

    /// Kills the server as `kill -9` does.
    pub fn kill(&mut self) {
        if let Some(mut child) = self.child.take() {
            child.kill().unwrap();
            child.wait().unwrap();
        }
    }

    /// Creates a database on the server.
    pub fn database(&self, name: &str) -> Server {
        self.ask("postgres")
            .batch_execute(&format!("CREATE DATABASE {name}"))
            .unwrap();
        self.named(name)
    }

    pub fn named(&self, name: &str) -> Server {
        let address = self.address(name);
        Server { address }
    }

    pub fn ask(&self, database: &str) -> Client {
        Client::connect(&self.address(database), NoTls).unwrap()
    }

    fn address(&self, database: &str) -> String {
        format!(
            "host={} user=stand dbname={database}",
            self.folder.path().display()
        )
    }

    fn data(&self) -> PathBuf {
        self.folder.path().join("data")
    }

    fn program(&self, name: &str) -> Command {
        let mut command = Command::new(self.programs.join(name));
        command.current_dir(self.folder.path());
        command
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::piped());
        if name == "postgres" {
            command.stderr(Stdio::null());
        }
        if is_root() {
            command.uid(NOBODY).gid(NOBODY);
        }
        command
    }
}

impl Drop for Postgres {
    fn drop(&mut self) {
        self.kill();
    }
}

/// Returns the folder of `initdb` and `postgres`. Debian has one folder per version, and none of them is in
/// `PATH`.
fn programs() -> Option<PathBuf> {
    let debian = fs::read_dir("/usr/lib/postgresql").into_iter().flatten();
    let mut folders: Vec<PathBuf> = debian
        .flatten()
        .map(|entry| entry.path().join("bin"))
        .collect();
    folders.sort();
    folders.reverse();
    folders.extend(env::split_paths(&env::var_os("PATH").unwrap_or_default()));
    let is_it = |folder: &PathBuf| {
        ["initdb", "postgres"]
            .iter()
            .all(|name| folder.join(name).is_file())
    };
    folders.into_iter().find(is_it)
}

fn is_root() -> bool {
    use std::os::unix::fs::MetadataExt;
    fs::metadata(Path::new("/proc/self")).is_ok_and(|own| own.uid() == 0)
}
