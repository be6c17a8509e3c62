//! Texts of the public stand, for visitors and for staff.

use super::Language;
use jiff::civil::Time;

/// Texts of the public stand.
#[allow(missing_docs)] // the field names say it
pub struct StandWords {
    pub call: &'static str,
    pub which: &'static str,
    pub still_there: &'static str,
    pub take_home: &'static str,
    pub scan: &'static str,
    pub another: &'static str,
    pub opens: fn(Time) -> String,
    pub rests: &'static str,
    pub door: &'static str,
    pub wrong: &'static str,
    pub wait: fn(f64) -> String,
    /// Names of the staff pages.
    pub pages: [&'static str; 3],
    pub figures: [&'static str; 8],
    pub health: [&'static str; 10],
    pub seconds: fn(f32) -> String,
    pub bytes: fn(u64) -> String,
    pub unknown: &'static str,
    pub recording: &'static str,
    pub levels: &'static str,
    pub hours: &'static str,
    pub always: &'static str,
    pub from_to: fn(Time, Time) -> String,
    pub try_stick: &'static str,
    pub export: &'static str,
    pub exported: fn(&str) -> String,
    pub end: &'static str,
    pub ends: &'static str,
    pub end_now: &'static str,
    pub keep_open: &'static str,
    pub off: &'static str,
}

impl Language {
    /// Texts of the public stand in this language.
    pub fn at_stand(self) -> &'static StandWords {
        match self {
            Self::English => &ENGLISH,
            Self::Japanese => &JAPANESE,
        }
    }
}

const ENGLISH: StandWords = StandWords {
    call: "Touch anything to play!",
    which: "Which one?",
    still_there: "Still there?",
    take_home: "Take your round home",
    scan: "Scan with your phone",
    another: "Another level",
    opens: |open| format!("We open at {}", open.strftime("%H:%M")),
    rests: "Out of order. Please tell the staff.",
    door: "Staff",
    wrong: "Wrong PIN",
    wait: |seconds| format!("Wait {seconds:.0} s"),
    pages: ["Today", "Health", "Stand"],
    figures: [
        "Visits",
        "Rounds",
        "Won",
        "Squeezed in whole",
        "Shaved",
        "Shaved and squeezed",
        "Restarted",
        "Median time to first win",
    ],
    health: [
        "Frame time, median",
        "Frame time, 99th percentile",
        "Memory",
        "Free disk space",
        "Sticks and pads",
        "Forces",
        "Sound",
        "Logbook",
        "Logbook size",
        "Not yet sent to the server",
    ],
    seconds: |seconds| format!("{seconds:.1} s"),
    bytes: |bytes| megabytes(bytes),
    unknown: "unknown",
    recording: "recording",
    levels: "Levels",
    hours: "Opening hours",
    always: "always",
    from_to: |open, close| format!("{} to {}", open.strftime("%H:%M"), close.strftime("%H:%M")),
    try_stick: "Try the stick",
    export: "Copy the logbook",
    exported: |path| format!("Copied to {path}"),
    end: "End the game",
    ends: "End the game? The screen stays dark until the machine or the service is started again.",
    end_now: "Yes, end it",
    keep_open: "No, keep it open",
    off: "off",
};

const JAPANESE: StandWords = StandWords {
    call: "さわって あそぼう！",
    which: "どれで あそぶ？",
    still_there: "まだ あそんでる？",
    take_home: "きみのプレイを もちかえろう",
    scan: "スマホで よみとってね",
    another: "ほかのステージ",
    opens: |open| format!("{}から あそべます", open.strftime("%H:%M")),
    rests: "ただいま こしょう中です。かかりの人に 知らせてください。",
    door: "スタッフ",
    wrong: "番号がちがいます",
    wait: |seconds| format!("あと{seconds:.0}秒 待ってください"),
    pages: ["今日", "状態", "スタンド"],
    figures: [
        "来館者（組）",
        "プレイ",
        "クリア",
        "まるごと 入った",
        "けずって 入った",
        "けずって おしこんだ",
        "やりなおし",
        "はじめてクリアするまで（中央値）",
    ],
    health: [
        "フレーム時間（中央値）",
        "フレーム時間（99パーセンタイル）",
        "メモリ",
        "ディスクの空き",
        "スティックとパッド",
        "手ごたえ",
        "音",
        "記録",
        "記録の大きさ",
        "サーバー送信待ち",
    ],
    seconds: |seconds| format!("{seconds:.1}秒"),
    bytes: |bytes| megabytes(bytes),
    unknown: "不明",
    recording: "記録中",
    levels: "ステージ",
    hours: "開館時間",
    always: "いつも",
    from_to: |open, close| format!("{}～{}", open.strftime("%H:%M"), close.strftime("%H:%M")),
    try_stick: "スティックをためす",
    export: "記録をコピー",
    exported: |path| format!("コピーしました：{path}"),
    end: "ゲームを おわる",
    ends: "ゲームを おわりますか？ コンピューターかサービスを もう一度 起動するまで 画面は暗いままです。",
    end_now: "はい、おわる",
    keep_open: "いいえ、つづける",
    off: "切",
};

fn megabytes(bytes: u64) -> String {
    match bytes as f64 / 1e6 {
        small if small < 1000.0 => format!("{small:.1} MB"),
        large => format!("{:.1} GB", large / 1e3),
    }
}
