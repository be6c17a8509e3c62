//! 日本語

use super::Words;
use crate::input::{Action, Means};
use force_feedback::{Ability, Stop};
use tamaire_play::level::LevelError;
use tamaire_play::link::{LinkError, MAX_LENGTH};
use tamaire_play::{Assist, ReplayError, Route};

pub(super) const WORDS: Words = Words {
    play: "あそぶ",
    replays: "リプレイ",
    settings: "せってい",
    quit: "おわる",
    back: "もどる",
    paused: "ひとやすみ",
    go_on: "つづける",
    again: "もういちど",
    levels: "ステージ",
    next: "つぎへ",
    other_way: |route| match route {
        Route::Squeeze => "こんどは けずってみよう！",
        Route::Shave | Route::Mix => "こんどは まるごと おしこもう！",
    },
    route: |route| match route {
        Route::Squeeze => "押し込み！",
        Route::Shave => "削り！",
        Route::Mix => "けずって 押し込み！",
    },
    wish: |wish| {
        let mut parts = Vec::new();
        if let Some(route) = wish.route {
            parts.push(match route {
                Route::Squeeze => "まるごと押し込む".to_string(),
                Route::Shave => "けずって入れる".to_string(),
                Route::Mix => "りょうほう".to_string(),
            });
        }
        parts.extend(wish.seconds.map(|most| format!("{most}秒いない")));
        parts.extend(
            wish.kept
                .map(|least| format!("{:.0}％のこす", 100.0 * least)),
        );
        parts.extend(wish.pieces.map(|least| format!("{least}こにわける")));
        parts.join("・")
    },
    summary: |outcome| {
        [
            ("タイム", format!("{:.1}秒", outcome.seconds())),
            ("のこした", format!("{:.0}％", 100.0 * outcome.kept)),
            ("かごの中", format!("{:.0}％", 100.0 * outcome.inside)),
            ("かけら", format!("{}こ", outcome.pieces)),
        ]
    },
    new_best: "新記録！",
    watch: "見る",
    race: "きょうそう",
    save: "リプレイをのこす",
    delete: "けす",
    surely: "ほんとに？",
    take_out: "はずす",
    saved: "のこしました",
    slow: |share| {
        format!(
            "この きかいには重いステージです。{:.0} %の はやさで うごきます。",
            100.0 * share
        )
    },
    licences: "ライセンス",
    link: "リンクをコピー",
    link_to_level: "このステージのリンク",
    link_copied: "リンクをコピーしました。どこにでも はりつけられます。",
    link_refused: "クリップボードが使えないため、リンクをコピーできませんでした。",
    link_error,
    offered: "だれかの リプレイが とどきました",
    download: "ダウンロード",
    no_replays: "まだありません。かったあとにのこすか、ファイルをここへ。",
    open: "ひらく…",
    what_opens: "レベル・絵・モデル・リプレイ",
    no_dialog: "このパソコンには ファイルをえらぶ まどがありません。ファイルを ここに おとしてね。",
    race_best: "じぶんの きろくと きょうそう",
    hands_section: "手",
    toggle_keys: "キーは もういちど おすまで おしたまま",
    dwell: "マウスを とめると ボタンを おす",
    scanning: "スイッチひとつで じゅんばんに",
    how_by_switch: "スイッチ：やじるしのほうへ",
    assists_section: "おたすけ（つぎの ラウンドから）",
    assist: |assist| match assist {
        Assist::WiderBasket => "かごを ひろく",
        Assist::Unbreakable => "ちぎれない からだ",
    },
    assisted: "おたすけあり",
    legend: [
        "クリア",
        "ねがいが かなった",
        "まるごと おしこんだ",
        "けずって 入れた",
        "りったい",
    ],
    language: "ことば",
    volume: "音量",
    effects: "効果音",
    music: "音楽",
    interface: "メニュー音",
    haptics: "手ごたえ",
    forces: "スティックとパッド",
    try_forces: "スティックとパッド…",
    no_devices: "スティックもパッドも つながっていません。",
    ability: |ability| match ability {
        Ability::Force => "おしかえせます",
        Ability::Rumble => "しんどうできます",
        Ability::Nothing => "手ごたえは ありません",
    },
    forces_off: "手ごたえが0なので、何も送りません",
    silent: |why| match why {
        Stop::Unheard | Stop::Idle => "なし：だれも使っていません",
        Stop::Paused => "なし：ひとやすみ中",
        Stop::FocusLost => "なし：ほかのウィンドウが前にあります",
        Stop::Menu => "なし：メニュー中",
        Stop::Won => "なし：もう かちました",
        Stop::Reset => "なし：はじまるところです",
        Stop::Unplugged => "なし：ぬけています",
        Stop::Stale => "なし：ゲームが おそすぎます",
        Stop::Emergency => "なし：手ごたえを切りました",
        Stop::Ended => "なし：手ごたえが こわれました",
    },
    motors: ["おそいモーター", "はやいモーター"],
    gains: ["強さ ←→", "強さ ↑↓"],
    try_it: "ためす",
    enough: "おわり",
    push_it: "スティックをたおすと おしかえし、はしまで行くと ふっと軽くなります。",
    measure: "モーターの向きをはかる",
    hands_off: "まっすぐ立てて 手をはなしてね。かってに動きます。",
    measured: "モーターの向きが わかりました。",
    not_measured: "うまくはかれませんでした。まっすぐ立てて、はかるあいだは 手をはなしてね。",
    built: |built| match (built.swap, built.invert) {
        (false, [false, false]) => "モーターの向き：ふつう".into(),
        (swap, [x, y]) => {
            let parts = [(swap, "入れかえ"), (x, "←→ が反対"), (y, "↑↓ が反対")];
            let parts: Vec<&str> = parts
                .iter()
                .filter(|part| part.0)
                .map(|part| part.1)
                .collect();
            format!("モーターの向き：{}", parts.join("・"))
        }
    },
    as_usual: "ふつうにもどす",
    forces_cut: "手ごたえ オフ",
    cut_now: "手ごたえを切りました。せっていの「スティックとパッド」で もどせます。",
    cut_hint: |[keys, buttons]| {
        format!("キーボードの {keys} か、ボタン {buttons} をおすと、手ごたえが すぐ切れます。")
    },
    restore: "手ごたえをもどす",
    restored: "手ごたえをもどしました。",
    forces_zero: "せっていが読めなかったので、手ごたえは えらぶまで0です。",
    speed: "はやさ",
    sensitivity: "うごきの大きさ",
    stick_places: "スティックで場所をさす",
    photo: "しゃしん",
    clip: "どうが",
    full_screen: "ぜんがめん（F11）",
    reduced_motion: "うごきをへらす",
    colour_safe: "見分けやすい色",
    text_size: "文字の大きさ",
    controls: "そうさ",
    press_any: "キーかボタンをおしてね…",
    reset: "もとにもどす",
    sound_section: "おと",
    play_section: "あそび",
    look_section: "見た目",
    action: |action| match action {
        Action::Up => "上",
        Action::Down => "下",
        Action::Left => "左",
        Action::Right => "右",
        Action::Retry => "やりなおす",
        Action::Pause => "ひとやすみ",
        Action::Elements => "要素を見る",
        Action::Slow => "スロー",
        Action::Step => "コマおくり",
        Action::Join => "ふたりで",
        Action::Raise => "上げる（3D）",
        Action::Lower => "下げる（3D）",
        Action::TurnLeft => "左から見る（3D）",
        Action::TurnRight => "右から見る（3D）",
        Action::Deeper => "要素のおくを見る（3D）",
        Action::Shallower => "要素の手前を見る（3D）",
        Action::CutForces => "手ごたえを切る",
    },
    on: "オン",
    off: "オフ",
    no_sound: "音が出ません",
    no_sticks: "スティックやパッドは使えません。",
    join_hint: "ふたりで",
    how_in_space: |means, [ways, up, around]| match means {
        Means::Mouse => [
            "動かす：マウス".into(),
            format!("上げ下げ：ホイール、または {up}"),
            format!("見まわす：右ボタンを引く、または {around}"),
        ],
        Means::Fingers => [
            "動かす：指一本".into(),
            "上げ下げ：もう一本の指を上下に".into(),
            "見まわす：もう一本の指を横に".into(),
        ],
        Means::Keys => [
            format!("動かす：{ways}"),
            format!("上げ下げ：{up}"),
            format!("見まわす：{around}"),
        ],
        Means::Pad => [
            "動かす：左スティック".into(),
            "上げ下げ：トリガー".into(),
            "見まわす：右スティック".into(),
        ],
        Means::Stick => [
            "動かす：スティック".into(),
            format!("上げ下げ：ボタン {up}"),
            format!("見まわす：ボタン {around}"),
        ],
    },
    look_inside: |means, [deeper, back]| match means {
        Means::Mouse => Some(format!("ホイールを上へ、または {deeper}：もっとおくを見る")),
        Means::Keys | Means::Stick => Some(format!("{deeper}：もっとおく、{back}：もっと手前")),
        Means::Pad => Some("右スティックをおす：もっとおく、左：もっと手前".into()),
        Means::Fingers => None,
    },
    watching: "リプレイ",
    damaged: |refused, aside| match aside {
        Some(aside) => {
            format!("読めないところがありました：{refused}。もとのまま {aside} にのこしました。")
        }
        None => format!("読めませんでした：{refused}。"),
    },
    not_written: "書きこめませんでした：",
    full: "空きがないため、のこせませんでした。",
    level_error,
    replay_error,
};

/// What went wrong; details, which name fields and lines of files, stay as they are.
fn level_error(error: &LevelError) -> String {
    match error {
        LevelError::Unreadable(file, reason) => format!("読めませんでした。{file}: {reason}"),
        LevelError::Scene(scene) => format!("このステージは読めませんでした。{scene}"),
        LevelError::NoBody(reason) => {
            format!("このファイルからは からだを作れませんでした。{reason}")
        }
        LevelError::NoGame { id, field, reason } => {
            format!("「{id}」は、このままでは あそべません。{field}: {reason}")
        }
        LevelError::Unknown { id, .. } => {
            format!("「{id}」というステージもファイルもありません。")
        }
    }
}

fn replay_error(error: &ReplayError) -> String {
    match error {
        ReplayError::Unreadable(reason) => format!("読めませんでした。{reason}"),
        ReplayError::Text(reason) => format!("リプレイではないようです。{reason}"),
        ReplayError::Version { found } => {
            format!("ほかのバージョン（{found}）のリプレイなので、見られません。")
        }
        ReplayError::Level(level) => level_error(level),
        ReplayError::LevelChanged => "このリプレイのステージは、書きかえられています。".into(),
        ReplayError::Differs { second } => {
            format!("このリプレイは書きかえられています。{second}秒から ちがいます。")
        }
        ReplayError::OutcomeDiffers => {
            "このリプレイは書きかえられています。けっかが ちがいます。".into()
        }
    }
}

fn link_error(error: &LinkError) -> String {
    match error {
        LinkError::Other => "これは tamaire のリンクではありません。".into(),
        LinkError::Newer => "新しいバージョンの tamaire で作られたリンクです。".into(),
        LinkError::CutShort => "リンクの終わりが ありません。".into(),
        LinkError::Damaged => "リンクが とちゅうで かわったか、ぜんぶ とどいていません。".into(),
        LinkError::TooLong { found } => {
            format!("リンクにするには長すぎます（{found}文字。{MAX_LENGTH}文字まで）。")
        }
        LinkError::LevelDiffers(level) => {
            format!("「{level}」は、リンクが作られたときと ちがうステージです。")
        }
        LinkError::Round(round) => replay_error(round),
        LinkError::Level(level) => level_error(level),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tamaire_play::Level;

    #[test]
    fn what_is_wrong_is_said_in_japanese_and_where_it_stands_is_kept() {
        let unknown = level_error(&Level::open("nowhere").unwrap_err());
        assert!(unknown.contains("nowhere") && unknown.contains("ありません"));
        let refused = |name: &str, bytes: &str| {
            let nothing = |_: &str| Err(std::io::ErrorKind::NotFound.into());
            level_error(&Level::read(name, bytes.as_bytes(), &nothing).unwrap_err())
        };
        let broken = refused("a.toml", "dim = 2\ngravity = \"down\"\n");
        assert!(broken.contains("読めません") && broken.contains("line 2"));
        let model = refused("a.vox", "VOX");
        assert!(model.contains("からだを作れませんでした。a.vox"), "{model}");
        let old = replay_error(&ReplayError::Version { found: 7 });
        assert!(old.contains("バージョン（7）"), "{old}");
    }
}
