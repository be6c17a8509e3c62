//! What is said at a stand in public, to visitors and to staff.

use super::Language;
use jiff::civil::Time;

/// What is said at a stand.
#[allow(missing_docs)] // each field says what it is
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
    /// What staff can look at.
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
    pub off: &'static str,
}

impl Language {
    /// What is said in it at a stand.
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
    scan: "Point a phone at it",
    another: "Another one",
    opens: |open| format!("We open at {}", open.strftime("%H:%M")),
    rests: "This game takes a rest. Please tell the staff.",
    door: "Staff",
    wrong: "Not this number",
    wait: |seconds| format!("Wait {seconds:.0} s"),
    pages: ["Today", "Health", "Stand"],
    figures: [
        "Visits",
        "Rounds",
        "Won",
        "Squeezed in whole",
        "Shaved",
        "Some of both",
        "Begun again",
        "Half had won after",
    ],
    health: [
        "A frame, usually",
        "1 of 100 takes longer than",
        "Memory",
        "Room on the disk",
        "Sticks and pads",
        "Forces",
        "Sound",
        "Logbook",
        "Size of the logbook",
        "Waiting for the server",
    ],
    seconds: |seconds| format!("{seconds:.1} s"),
    bytes: |bytes| megabytes(bytes),
    unknown: "not known",
    recording: "records",
    levels: "Levels",
    hours: "Open",
    always: "always",
    from_to: |open, close| format!("{} to {}", open.strftime("%H:%M"), close.strftime("%H:%M")),
    try_stick: "Try the stick",
    export: "Copy the logbook",
    exported: |path| format!("Copied to {path}"),
    end: "End the game",
    ends: "Then the screen stays dark until the machine or the service is started again.",
    off: "off",
};

const JAPANESE: StandWords = StandWords {
    call: "さわって あそぼう！",
    which: "どれで あそぶ？",
    still_there: "まだ あそんでる？",
    take_home: "きみのプレイを もちかえろう",
    scan: "スマホで よみとってね",
    another: "ほかのステージ",
    opens: |open| format!("{}に ひらきます", open.strftime("%H:%M")),
    rests: "いま おやすみちゅうです。かかりの人に しらせてください。",
    door: "スタッフ",
    wrong: "ばんごうが ちがいます",
    wait: |seconds| format!("あと{seconds:.0}秒 まってください"),
    pages: ["今日", "状態", "スタンド"],
    figures: [
        "来館者（組）",
        "プレイ",
        "入った",
        "押し込み",
        "削り",
        "りょうほう",
        "やりなおし",
        "はじめて入るまで（中央値）",
    ],
    health: [
        "ふだんの1コマ",
        "100コマに1つは これよりおそい",
        "メモリ",
        "ディスクの空き",
        "スティックとパッド",
        "力",
        "音",
        "記録",
        "記録の大きさ",
        "サーバー送信待ち",
    ],
    seconds: |seconds| format!("{seconds:.1}秒"),
    bytes: |bytes| megabytes(bytes),
    unknown: "わからない",
    recording: "記録中",
    levels: "ステージ",
    hours: "あいている時間",
    always: "いつも",
    from_to: |open, close| format!("{}～{}", open.strftime("%H:%M"), close.strftime("%H:%M")),
    try_stick: "スティックをためす",
    export: "記録をコピー",
    exported: |path| format!("コピーしました：{path}"),
    end: "ゲームを おわる",
    ends: "おわると、コンピューターかサービスを もう一度 起動するまで 画面は暗いままです。",
    off: "切",
};

fn megabytes(bytes: u64) -> String {
    match bytes as f64 / 1e6 {
        small if small < 1000.0 => format!("{small:.1} MB"),
        large => format!("{:.1} GB", large / 1e3),
    }
}
