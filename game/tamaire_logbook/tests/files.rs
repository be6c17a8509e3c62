//! Tests of unusable files and of copies.

mod common;

use common::{MORNING, STAND, all, entries, execute, open, place};
use rusqlite::Connection;
use std::fs;
use std::path::{Path, PathBuf};
use std::thread;
use tamaire_logbook::{Error, Logbook};

/// Writes the rows of 30 visits and closes the logbook, so that SQLite leaves no other files beside it.
fn fill(path: &Path) {
    let mut book = open(path);
    for _ in 0..30 {
        book.write_all(&entries(MORNING)).unwrap();
    }
}

fn beside(path: &Path, ending: &str) -> PathBuf {
    path.with_added_extension(ending)
        .to_string_lossy()
        .replace(".-", "-")
        .into()
}

/// Checks that opening the file at `path` renames it and creates a new logbook that works. Returns the
/// content of the renamed file.
fn expect_set_aside(path: &Path, reason: &str) -> Vec<u8> {
    let (mut book, set_aside) = Logbook::open(path, STAND).unwrap();
    let set_aside = set_aside.expect("the file must be set aside");
    assert!(set_aside.reason.contains(reason), "{set_aside:?}");
    let name = set_aside.path.file_name().unwrap().to_str().unwrap();
    assert!(
        name.starts_with("logbook.damaged-20") && name.ends_with(".sqlite"),
        "{name}"
    );
    assert_eq!(all(&book).unwrap().rounds.len(), 0);
    book.write_all(&entries(MORNING)).unwrap();
    drop(book);
    assert_eq!(all(&open(path)).unwrap().rounds.len(), 3);
    fs::read(&set_aside.path).unwrap()
}

#[test]
fn open_sets_aside_files_that_are_no_logbooks() {
    let (_folder, path) = place();
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(&path, "").unwrap();
    assert_eq!(expect_set_aside(&path, "empty"), b"");
    // A second file set aside within the same second gets another name.
    for text in ["Dear diary", &"no database. ".repeat(1000)] {
        fs::write(&path, text).unwrap();
        assert_eq!(expect_set_aside(&path, "not a database"), text.as_bytes());
    }
    fs::remove_file(&path).unwrap();
    execute(&path, "CREATE TABLE recipes (text TEXT)");
    expect_set_aside(&path, "another program");
    // The file has the application id of a logbook, but its tables differ.
    execute(
        &path,
        "DROP TABLE replays; ALTER TABLE rounds DROP COLUMN inside",
    );
    expect_set_aside(&path, "no such");
    execute(&path, "DELETE FROM book");
    expect_set_aside(&path, "no rows");
}

/// All threads must write into the same file, in whichever order they open it.
#[test]
fn open_from_several_threads_creates_one_file() {
    let (_folder, path) = place();
    thread::scope(|scope| {
        for _ in 0..8 {
            scope.spawn(|| open(&path).write_all(&entries(MORNING)).unwrap());
        }
    });
    assert_eq!(all(&open(&path)).unwrap().rounds.len(), 24);
    let names = fs::read_dir(path.parent().unwrap()).unwrap();
    let is_ours = |name: String| name.starts_with("logbook.sqlite") && !name.contains("new");
    assert!(
        names
            .into_iter()
            .all(|entry| is_ours(entry.unwrap().file_name().into_string().unwrap()))
    );
}

#[test]
fn open_sets_aside_a_truncated_file_unchanged() {
    let (_folder, path) = place();
    fill(&path);
    let whole = fs::read(&path).unwrap();
    assert!(whole.len() > 10 * 4096, "{}", whole.len());
    let near_end = [whole.len() - 4096, whole.len() - 1];
    for length in [1, 99, 100, 512, 4095, 4096, 5000, 12_288]
        .into_iter()
        .chain(near_end)
    {
        fs::write(&path, &whole[..length]).unwrap();
        assert_eq!(expect_set_aside(&path, ""), whole[..length]);
    }
}

/// A file with changed bytes is either opened or set aside unchanged. In both cases, writing and reading must
/// not panic.
#[test]
fn open_handles_changed_bytes_without_panic() {
    let (_folder, path) = place();
    fill(&path);
    let whole = fs::read(&path).unwrap();
    let mut random = fastrand::Rng::with_seed(3);
    let (mut aside, mut silent) = (0, 0);
    for attempt in 0..300 {
        let mut changed = whole.clone();
        // Each of the attempts 0 to 99 changes one byte of the header. Each of the attempts 100 to 199
        // changes one byte of the first 12 pages. Each later attempt changes up to 600 bytes anywhere.
        match attempt {
            0..100 => changed[attempt] ^= 0xff,
            100..200 => {
                let place = random.usize(..4096 * 12);
                changed[place] = random.u8(..);
            }
            _ => {
                let place = random.usize(..whole.len() - 600);
                changed[place..place + random.usize(1..600)].fill_with(|| random.u8(..));
            }
        }
        fs::write(&path, &changed).unwrap();
        match Logbook::open(&path, STAND) {
            Ok((mut book, Some(set_aside))) => {
                aside += 1;
                assert_eq!(fs::read(&set_aside.path).unwrap(), changed);
                fs::remove_file(&set_aside.path).unwrap();
                book.write_all(&entries(MORNING)).unwrap();
            }
            // The check does not find all damage. If such damage appears later, it must be reported.
            Ok((mut book, None)) => {
                silent += 1;
                let written = book.write_all(&entries(MORNING));
                for result in [written, all(&book).map(drop), book.today(MORNING).map(drop)] {
                    assert!(
                        matches!(
                            result,
                            Ok(()) | Err(Error::Damaged { .. } | Error::Refused { .. })
                        ),
                        "{attempt}: {result:?}"
                    );
                }
            }
            Err(Error::Newer { .. }) => assert!((60..64).contains(&attempt), "{attempt}"),
            Err(error) => panic!("{attempt}: {error}"),
        }
        for ending in ["-wal", "-shm"] {
            let _ = fs::remove_file(beside(&path, ending));
        }
    }
    assert!(aside > 50 && silent > 50, "{aside}, {silent}");
}

#[test]
fn set_aside_also_renames_the_write_ahead_log() {
    let (_folder, path) = place();
    fill(&path);
    let mut book = open(&path);
    book.write_all(&entries(MORNING)).unwrap();
    let (file, log) = (
        fs::read(&path).unwrap(),
        fs::read(beside(&path, "-wal")).unwrap(),
    );
    drop(book);
    assert!(log.len() > 4096);
    fs::write(&path, &file[..file.len() / 2]).unwrap();
    fs::write(beside(&path, "-wal"), &log).unwrap();
    let (book, set_aside) = Logbook::open(&path, STAND).unwrap();
    let aside = set_aside.unwrap().path;
    assert_eq!(
        all(&book).unwrap().rounds.len(),
        0,
        "an old -wal file must not be used for a new database"
    );
    assert_eq!(fs::read(&aside).unwrap(), file[..file.len() / 2]);
    assert_eq!(fs::read(beside(&aside, "-wal")).unwrap(), log);
    drop(book);
    // If the database file is missing, its `-wal` file is renamed in the same way.
    fs::remove_file(&path).unwrap();
    fs::write(beside(&path, "-wal"), &log).unwrap();
    let (book, set_aside) = Logbook::open(&path, STAND).unwrap();
    let set_aside = set_aside.unwrap();
    assert!(set_aside.reason.contains("missing"), "{set_aside:?}");
    assert_eq!(all(&book).unwrap().rounds.len(), 0);
    assert_eq!(fs::read(beside(&set_aside.path, "-wal")).unwrap(), log);
}

#[test]
fn open_leaves_a_newer_version_unchanged() {
    let (_folder, path) = place();
    fill(&path);
    execute(
        &path,
        "CREATE TABLE weather (text TEXT); PRAGMA user_version = 2",
    );
    let before = fs::read(&path).unwrap();
    for error in [
        Logbook::open(&path, STAND).map(drop),
        Logbook::read(&path).map(drop),
    ] {
        let error = error.unwrap_err().to_string();
        let expected = "logbook of version 2: this program supports up to version 1";
        assert!(
            error.contains(expected) && error.contains("logbook.sqlite"),
            "{error}"
        );
    }
    assert_eq!(fs::read(&path).unwrap(), before);
    let names = fs::read_dir(path.parent().unwrap()).unwrap();
    let names = names.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    assert!(
        names
            .into_iter()
            .all(|name| name.starts_with("logbook.sqlite"))
    );
}

#[test]
fn write_reports_a_locked_file_and_succeeds_after_the_lock_is_released() {
    let (_folder, path) = place();
    let mut book = open(&path);
    let other = Connection::open(&path).unwrap();
    other.execute_batch("BEGIN IMMEDIATE").unwrap();
    let error = book.write_all(&entries(MORNING)).unwrap_err();
    assert!(matches!(error, Error::Locked(_)), "{error}");
    assert!(
        error.to_string().contains("another program is writing"),
        "{error}"
    );
    other.execute_batch("COMMIT").unwrap();
    book.write_all(&entries(MORNING)).unwrap();
    assert_eq!(all(&book).unwrap().rounds.len(), 3);
}

#[test]
fn write_reports_a_full_file_and_succeeds_after_the_limit_is_raised() {
    let (_folder, path) = place();
    fill(&path);
    let mut book = open(&path);
    let before = all(&book).unwrap();
    book.set_size_limit(1).unwrap();
    let refused = (0..1000).find_map(|_| book.write_all(&entries(MORNING)).err());
    let refused = refused.expect("the size limit must be reached");
    assert!(matches!(refused, Error::Full(_)), "{refused}");
    assert!(
        refused.to_string().ends_with("the disk is full"),
        "{refused}"
    );
    let kept = all(&book).unwrap();
    assert_eq!(
        kept.rounds.len() % 3,
        0,
        "write_all must write all of its entries or none"
    );
    assert!(kept.rounds.len() >= before.rounds.len());
    book.set_size_limit(1 << 30).unwrap();
    book.write_all(&entries(MORNING)).unwrap();
    assert_eq!(all(&book).unwrap().rounds.len(), kept.rounds.len() + 3);
}

#[test]
fn open_and_read_report_missing_and_unwritable_paths() {
    let (folder, path) = place();
    fs::write(
        folder.path().join("kept"),
        "a file where a folder should be",
    )
    .unwrap();
    let error = Logbook::open(&path, STAND).unwrap_err();
    assert!(matches!(error, Error::Unusable { .. }), "{error}");
    assert!(
        error
            .to_string()
            .contains("kept/logbook.sqlite: the logbook cannot be"),
        "{error}"
    );
    let error = Logbook::read(&folder.path().join("none")).unwrap_err();
    assert!(matches!(error, Error::Unusable { .. }), "{error}");
    let error = Logbook::read(&folder.path().join("kept")).unwrap_err();
    assert!(matches!(error, Error::Damaged { .. }), "{error}");
    assert!(
        folder.path().join("kept").is_file(),
        "reading must not rename the file"
    );
    // Folders without write permission.
    #[cfg(target_os = "linux")]
    for name in ["/proc/none/logbook.sqlite", "/proc/logbook.sqlite", "/proc"] {
        let error = Logbook::open(Path::new(name), STAND).unwrap_err();
        assert!(matches!(error, Error::Unusable { .. }), "{name}: {error}");
    }
}

/// A database and its log, copied while in use, contain all committed rows. The original stays usable.
#[test]
fn read_accepts_a_copy_taken_during_writing() {
    let (folder, path) = place();
    fill(&path);
    let mut book = open(&path);
    let mut told = 90;
    for attempt in 0..20 {
        book.write_all(&entries(MORNING)).unwrap();
        told += 3;
        let copy = folder.path().join(format!("copy {attempt}?.sqlite"));
        fs::copy(&path, &copy).unwrap();
        fs::copy(beside(&path, "-wal"), beside(&copy, "-wal")).unwrap();
        let copy = Logbook::read(&copy).unwrap();
        assert_eq!(all(&copy).unwrap().rounds.len(), told);
    }
    // A copy without the `-wal` file contains the rows up to the last checkpoint.
    let copy = folder.path().join("alone");
    fs::copy(&path, &copy).unwrap();
    assert_eq!(
        all(&Logbook::read(&copy).unwrap()).unwrap().rounds.len(),
        90
    );
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn read_creates_and_removes_no_file() {
    let (folder, path) = place();
    fill(&path);
    let kept = path.parent().unwrap();
    let check = |expected: &[&str], rounds: usize| {
        assert_eq!(names(kept), expected);
        let before = fs::read(&path).unwrap();
        let book = Logbook::read(&path).unwrap();
        assert_eq!(all(&book).unwrap().rounds.len(), rounds);
        assert_eq!(names(kept), expected);
        drop(book);
        assert_eq!(names(kept), expected);
        assert_eq!(fs::read(&path).unwrap(), before);
    };
    check(&["logbook.sqlite"], 90);
    let both = ["logbook.sqlite", "logbook.sqlite-shm", "logbook.sqlite-wal"];
    let mut book = open(&path);
    book.write_all(&entries(MORNING)).unwrap();
    check(&both, 93);
    // A copy of the file and of its log, without the shared memory.
    let log = fs::read(beside(&path, "-wal")).unwrap();
    let bytes = fs::read(&path).unwrap();
    drop(book);
    assert_eq!(names(kept), ["logbook.sqlite"]);
    fs::write(&path, bytes).unwrap();
    fs::write(beside(&path, "-wal"), log).unwrap();
    check(&["logbook.sqlite", "logbook.sqlite-wal"], 93);
    let error = Logbook::read(folder.path()).unwrap_err().to_string();
    assert!(error.contains("found a folder"), "{error}");
}

#[test]
fn read_ignores_a_lone_shared_memory_and_creates_no_log() {
    let (_folder, path) = place();
    fill(&path);
    fs::write(beside(&path, "-shm"), "left over").unwrap();
    let expected = ["logbook.sqlite", "logbook.sqlite-shm"];
    let book = Logbook::read(&path).unwrap();
    assert_eq!(all(&book).unwrap().rounds.len(), 90);
    assert_eq!(names(path.parent().unwrap()), expected);
    drop(book);
    assert_eq!(names(path.parent().unwrap()), expected);
    assert_eq!(fs::read(beside(&path, "-shm")).unwrap(), b"left over");
}

#[test]
fn read_of_an_idle_logbook_is_undisturbed_by_later_writes() {
    let (_folder, path) = place();
    fill(&path);
    let book = Logbook::read(&path).unwrap();
    let (mut rounds, mut writer) = (0, None);
    book.rounds(.., |_| {
        // Begins to write after the first row, when the rest of the file has not been read.
        let writer = writer.get_or_insert_with(|| open(&path));
        writer.write_all(&entries(MORNING))?;
        rounds += 1;
        Ok::<(), Error>(())
    })
    .unwrap();
    assert_eq!(rounds, 90);
    // Closing copies the log into the file. The open copy must not change.
    drop(writer);
    assert_eq!(all(&book).unwrap().rounds.len(), 90);
    drop(book);
    assert_eq!(names(path.parent().unwrap()), ["logbook.sqlite"]);
    let later = Logbook::read(&path).unwrap();
    assert_eq!(all(&later).unwrap().rounds.len(), 90 + 90 * 3);
}
