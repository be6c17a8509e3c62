//! Invalid files and hostile texts.

use crate::made_up::{Rows, rows};
use crate::{all_files, logbooks, report_on};
use std::fs;
use std::path::Path;
use tamaire_logbook::Logbook;
use tamaire_report::{Language, Options};

/// Returns the names of the files in a folder.
fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn report_names_unreadable_files_and_leaves_no_output() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let good = logbooks(&at("good"), &[rows(1, 3)]).remove(0);
    fs::write(at("letter.txt"), "Dear logbook,").unwrap();
    fs::write(at("empty"), "").unwrap();
    fs::copy(&good, at("newer")).unwrap();
    // An SQLite file has its user version at byte 60.
    let mut bytes = fs::read(at("newer")).unwrap();
    bytes[60..64].copy_from_slice(&999_u32.to_be_bytes());
    fs::write(at("newer"), &bytes).unwrap();
    fs::write(at("short"), &bytes[..bytes.len() / 2]).unwrap();

    for wrong in ["missing", "letter.txt", "empty", "newer", "short", "good"] {
        let files = [good.clone(), at(wrong)];
        let error = report_on(&files, &at("report"), &all_files())
            .unwrap_err()
            .to_string();
        assert!(
            error.contains(wrong) && error.len() < 500,
            "{wrong}: {error}"
        );
        assert!(!at("report").exists(), "{wrong}");
    }
    let error = report_on(&[], &at("report"), &all_files())
        .unwrap_err()
        .to_string();
    assert!(error.contains("at least one logbook"), "{error}");
    let days = Options {
        from: Some("2026-11-02".parse().unwrap()),
        to: Some("2026-11-01".parse().unwrap()),
        ..Options::default()
    };
    let error = report_on(&[good], &at("report"), &days)
        .unwrap_err()
        .to_string();
    assert!(error.contains("2026-11-02 and 2026-11-01"), "{error}");
}

#[test]
fn report_names_unwritable_files_and_keeps_the_last_report() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let files = logbooks(&at("good"), &[rows(1, 3)]);
    fs::write(at("file"), "").unwrap();
    for out in ["file", "file/report"] {
        let error = report_on(&files, &at(out), &all_files())
            .unwrap_err()
            .to_string();
        assert!(error.contains(&at("file").display().to_string()), "{error}");
    }

    let out = at("report");
    report_on(&files, &out, &Options::default()).unwrap();
    assert_eq!(names(&out), ["index.html"]);
    let before = fs::read(out.join("index.html")).unwrap();
    fs::create_dir(out.join("report.json")).unwrap();
    let error = report_on(&files, &out, &all_files())
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("report.json: cannot be written: a folder has this name"),
        "{error}"
    );
    assert_eq!(names(&out), ["index.html", "report.json"]);
    assert_eq!(fs::read(out.join("index.html")).unwrap(), before);

    fs::remove_dir(out.join("report.json")).unwrap();
    let report = report_on(&files, &out, &all_files()).unwrap();
    assert_eq!(
        names(&out),
        [
            "events.csv",
            "index.html",
            "report.json",
            "rounds.csv",
            "visits.csv"
        ]
    );
    assert_eq!(report.files.len(), 5);
}

#[test]
fn hostile_texts_are_escaped_in_page_and_tables() {
    let hostile = "=1+1</title><script>alert('\"&')</script><img src=http://example.org/x onerror=alert(1)>\u{202E}";
    let mut rows = rows(1, 40);
    for visit in &mut rows.visits {
        visit.stand = hostile.into();
        visit.language = hostile.into();
    }
    for (k, round) in rows.rounds.iter_mut().enumerate() {
        round.stand = hostile.into();
        round.level = format!("{hostile}{}", k % 3);
    }
    for event in &mut rows.events {
        event.kind = tamaire_logbook::Kind::Other(hostile.into());
        event.text = format!("{hostile}\r\n,\"");
    }
    let folder = tempfile::tempdir().unwrap();
    let files = logbooks(folder.path(), &[rows]);
    for language in [Language::English, Language::Japanese] {
        let options = Options {
            language,
            ..all_files()
        };
        let report = report_on(&files, &folder.path().join("out"), &options).unwrap();
        let page = fs::read_to_string(&report.page).unwrap();
        assert!(page.contains("&lt;script&gt;"));
        for wrong in ["<script", "<img", "\u{202E}"] {
            assert!(!page.contains(wrong), "{wrong}");
        }
        // Apart from the SVG namespace, the page contains no address.
        let bare = page
            .replace("xmlns=\"http://www.w3.org/2000/svg\"", "")
            .replace("src=http://example.org/x", "");
        for address in ["http:", "https:", "src=", "href=", "@import", "url(h"] {
            assert!(!bare.contains(address), "{address}");
        }
    }
    for name in ["visits.csv", "rounds.csv", "events.csv"] {
        let text = fs::read_to_string(folder.path().join("out").join(name)).unwrap();
        assert!(
            text.contains("\"'=1+1") && !text.contains(",=") && !text.contains(",\"="),
            "{name}"
        );
    }
    let json = fs::read_to_string(folder.path().join("out/report.json")).unwrap();
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["stands"][0]["stand"], hostile);
}

#[test]
fn report_on_an_empty_logbook_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let files = logbooks(folder.path(), &[Rows::default()]);
    for (language, nothing) in [
        (Language::English, "no visit"),
        (Language::Japanese, "来場の記録がありません"),
    ] {
        let options = Options {
            language,
            ..all_files()
        };
        let report = report_on(&files, &folder.path().join("out"), &options).unwrap();
        let page = fs::read_to_string(&report.page).unwrap();
        assert!(page.contains(nothing) && !page.contains("NaN"));
        assert_eq!(report.figures.total.share_won, None);
    }
    assert!(Logbook::read(&files[0]).is_ok());
}
