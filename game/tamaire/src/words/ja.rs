//! Texts of the game in Japanese (日本語).

use super::Language;
use super::Words;
use super::{percent_below, percent_lost, percent_of_limit, tenths_above};
use crate::input::{Action, InputMethod};
use crate::settings::Quality;
use force_feedback::{Ability, Stop};
use fuwafuwa_render::frame::ElementColour;
use fuwafuwa_scenes::import::{ImportNote, NoteKind};
use fuwafuwa_scenes::scene::Form;
use tamaire_play::level::LevelError;
use tamaire_play::link::{LinkError, MAX_LENGTH};
use tamaire_play::playground::{Stuff, Tool};
use tamaire_play::{Assist, Joints, ReplayError, Route};

pub(super) const WORDS: Words = Words {
    play: "あそぶ",
    replays: "リプレイ",
    settings: "設定",
    quit: "おわる",
    back: "もどる",
    paused: "ひとやすみ",
    go_on: "つづける",
    again: "さいしょから",
    play_again: "もういちど",
    levels: "ステージ",
    next: "つぎへ",
    other_way: |route| match route {
        Route::Squeeze => "こんどは けずって 入れてみよう！",
        Route::Shave | Route::Mix => "こんどは まるごと 入れてみよう！",
    },
    route: |route| match route {
        Route::Squeeze => "まるごと 入った！",
        Route::Shave => "けずって 入った！",
        Route::Mix => "けずって おしこんだ！",
    },
    won_by_itself: "ひとりでに 入ったよ！",
    wish: |wish| {
        let mut parts = Vec::new();
        if let Some(route) = wish.route {
            parts.push(match route {
                Route::Squeeze => "まるごと入れる".to_string(),
                Route::Shave => "けずって入れる".to_string(),
                Route::Mix => "けずって おしこむ".to_string(),
            });
        }
        parts.extend(wish.seconds.map(|most| format!("{most}秒以内")));
        parts.extend(
            wish.kept
                .map(|least| format!("ちぎるのは {}％まで", percent_of_limit(1.0 - least))),
        );
        parts.extend(match (wish.pieces, wish.max_pieces) {
            (None, None) => None,
            (_, Some(1)) => Some("ちぎらない".into()),
            (Some(least), None) => Some(format!("{least}こ以上にわける")),
            (Some(least), Some(most)) if least == most => Some(format!("ちょうど{least}こ")),
            (Some(least), Some(most)) => Some(format!("{least}こから{most}こまで")),
            (None, Some(most)) => Some(format!("{most}こまで")),
        });
        parts.extend(wish.joints.map(|joints| match joints {
            Joints::Whole => "つなぎ目を切らない".to_string(),
            Joints::Broken => "つなぎ目を切る".to_string(),
        }));
        if !wish.whole.is_empty() {
            parts.push("こわれものを こわさない".to_string());
        }
        parts.extend(
            wish.inside
                .map(|least| format!("{}％以上入れる", percent_of_limit(least))),
        );
        parts.join("・")
    },
    summary: |outcome| {
        [
            ("タイム", time(outcome.seconds())),
            ("ちぎれた", format!("{}％", percent_lost(outcome))),
            ("かごの中", format!("{}％", percent_below(outcome.inside))),
            ("かけら", format!("{}こ", outcome.pieces)),
        ]
    },
    new_best: "新記録！",
    let_go: "手をはなして！",
    seconds: time,
    seconds_of: |here, all| format!("{here:.1} / {all:.1}秒"),
    fill_basket: "かごに 入れる",
    missed: |wish| {
        format!(
            "もう クリアできません：{}",
            (Language::Japanese.words().wish)(wish)
        )
    },
    wrong_basket: "かごがちがうよ！",
    chapter: |number, name| format!("{number}　{name}"),
    stars: |earned, all| format!("★ {earned}／{all}"),
    opens_with: |missing, before| format!("{before}章で あと★{missing}こで ひらく"),
    daily: "きょうの ステージ",
    first_levels: "クラシックと遊び場",
    more_levels: "ほかのステージ",
    own_levels: "じぶんのステージ",
    open_all: "すべての章をひらく",
    rewound: "まきもどしあり",
    hold_to_rewind: |key| format!("{key}を押しつづけると 時間がもどるよ。"),
    hopeless: "のこりが たりなくて、もうクリアできないよ。",
    empty_hand: "手に もう なにも ついていないよ。",
    nothing_falls: "ここでは なにも おちないよ。",
    watch: "見る",
    race: "きょうそう",
    show_way: "やりかたを 見る",
    save: "リプレイを保存",
    delete: "けす",
    confirm: "けしていい？",
    saved: |file, folder| match folder {
        Some(folder) => format!("{folder} に {file} を 保存しました"),
        None => format!("{file} を 保存しました"),
    },
    open_folder: "フォルダーをひらく",
    folder_not_opened: "フォルダーを ひらけませんでした：",
    slow: |share| {
        format!(
            "このステージは この機械には重すぎるので、{:.0} %の はやさで動いています。",
            100.0 * share
        )
    },
    licences: "ライセンス",
    link: "リンクをコピー",
    link_to_level: "このステージのリンク",
    link_copied: "リンクをコピーしました。すきなところに はりつけてね。",
    link_refused: "クリップボードが使えないため、リンクをコピーできませんでした。",
    link_error,
    offered: "リプレイが とどきました！",
    download: "ダウンロード",
    no_replays: "リプレイは まだありません。ひとやすみのときか クリアしたあとに 保存できます。ファイルを ここに おとしても いいよ。",
    open: "ひらく…",
    what_opens: "ステージ・絵・モデル・リプレイ",
    no_dialog: "このパソコンでは ファイルをえらぶ画面が 出せません。ファイルを ゲームの上に おとしてね。",
    race_best: "自分の記録と きょうそう",
    hands_section: "アクセシビリティ",
    toggle_keys: "固定キー",
    dwell: "マウスを止めてクリック",
    scanning: "スイッチひとつで操作",
    how_by_switch: "スイッチをおすと、やじるしのとおりに動くよ",
    calm: "おだやかモード：ちぎれない、いつも にこにこ",
    not_in_calm: "ちぎる ステージなので、おだやかモードでは あそべません。",
    assists_section: "やさしくする（つぎのラウンドから）",
    assist: |assist| match assist {
        Assist::WiderBasket => "広いかご",
        Assist::Unbreakable => "ちぎれない からだ",
    },
    assisted: "やさしいモード",
    assist_ignored: |name| {
        format!("「{name}」は ここでは使えません。このステージがクリアできなくなるからです。")
    },
    legend: [
        "クリア",
        "目標クリア",
        "まるごと おしこんだ",
        "けずって 入れた",
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
        Ability::Force => "おしかえします",
        Ability::Rumble => "振動します",
        Ability::Nothing => "手ごたえは ありません",
    },
    forces_off: "手ごたえが0なので、力は出ません",
    silent: |why| match why {
        Stop::NoState | Stop::Idle => "なし：だれも使っていません",
        Stop::Paused => "なし：ひとやすみ中",
        Stop::FocusLost => "なし：ほかのウィンドウが前にあります",
        Stop::Menu => "なし：メニュー中",
        Stop::Won => "なし：もうクリアしました",
        Stop::Reset => "なし：はじまるところです",
        Stop::Unplugged => "なし：つながっていません",
        Stop::Stale => "なし：ゲームの動きが おそすぎます",
        Stop::Emergency => "なし：手ごたえを切りました",
        Stop::Ended => "なし：手ごたえが動かなくなりました",
    },
    motors: ["おそいモーター", "はやいモーター"],
    gains: ["強さ ←→", "強さ ↑↓"],
    try_it: "ためす",
    enough: "やめる",
    push_it: "スティックをたおすと おしかえされて、はしまで行くと ふっと軽くなります。",
    measure: "モーターの向きをはかる",
    hands_off: "スティックをまっすぐ立てて、手をはなしてね。ひとりでに動きます。",
    measured: "モーターの向きが わかりました。",
    not_measured: "うまくはかれませんでした。スティックをまっすぐ立てて、はかるあいだは手をはなしてね。",
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
    cut_now: "手ごたえを切りました。設定の「スティックとパッド」で もどせます。",
    cut_hint: |[keys, buttons]| {
        format!("キーボードの {keys} か、ボタン {buttons} をおすと、手ごたえが すぐ切れます。")
    },
    restore: "手ごたえをもどす",
    restored: "手ごたえをもどしました。",
    forces_zero: "手ごたえの設定が読めなかったので、えらびなおすまで0にします。",
    speed: "ゲームのはやさ",
    sensitivity: "動きの大きさ",
    stick_places: "スティックの位置＝手の位置",
    photo: "写真",
    clip: "動画",
    full_screen: "全画面（F11）",
    reduced_motion: "動きをへらす",
    colour_safe: "見分けやすい色",
    text_size: "文字の大きさ",
    controls: "操作",
    press_any: "キーかボタンをおしてね…",
    reset: "初期設定にもどす",
    reset_question: "設定を はじめの状態に もどしますか？ ことばとアクセシビリティは そのままです。",
    reset_now: "もどす",
    cancel: "やめる",
    sound_section: "音",
    play_section: "あそび",
    look_section: "見た目",
    action: |action| match action {
        Action::Up => "上",
        Action::Down => "下",
        Action::Left => "左",
        Action::Right => "右",
        Action::Retry => "やりなおす",
        Action::Rewind => "まきもどす",
        Action::Pause => "ひとやすみ",
        Action::Elements => "要素を見る",
        Action::Slow => "スロー",
        Action::Step => "コマおくり",
        Action::Make => "つくるのに もどる",
        Action::Tool => "道具を つかう（おすなば）",
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
    no_sticks: "ここでは スティックやパッドは使えません。",
    join_hint: "ふたりで",
    how_in_space: |means, [ways, up, around]| match means {
        InputMethod::Mouse => [
            "動かす：マウス".into(),
            format!("上げ下げ：ホイール、または {up}"),
            format!("見まわす：右ボタンをおして動かす、または {around}"),
        ],
        InputMethod::Fingers => [
            "動かす：指一本".into(),
            "上げ下げ：もう一本の指を上下に".into(),
            "見まわす：もう一本の指を横に".into(),
        ],
        InputMethod::Keys => [
            format!("動かす：{ways}"),
            format!("上げ下げ：{up}"),
            format!("見まわす：{around}"),
        ],
        InputMethod::Pad => [
            "動かす：左スティック".into(),
            "上げ下げ：トリガー".into(),
            "見まわす：右スティック".into(),
        ],
        InputMethod::Stick => [
            "動かす：スティック".into(),
            format!("上げ下げ：ボタン {up}"),
            format!("見まわす：ボタン {around}"),
        ],
    },
    look_inside: |means, [deeper, back]| match means {
        InputMethod::Mouse => Some(format!("ホイールを上へ、または {deeper}：もっとおくを見る")),
        InputMethod::Keys | InputMethod::Stick => {
            Some(format!("{deeper}：もっとおく、{back}：もっと手前"))
        }
        InputMethod::Pad => Some("右スティックをおす：もっとおく、左：もっと手前".into()),
        InputMethod::Fingers => None,
    },
    watching: "リプレイ",
    position: "リプレイの位置",
    damaged: |refused, aside| match aside {
        Some(aside) => {
            format!(
                "読めないところがありました：{refused}。もとのファイルは {aside} に保存しました。"
            )
        }
        None => format!("読めませんでした：{refused}。"),
    },
    not_written: "保存できませんでした：",
    full: "空きがないので、保存できませんでした。",
    level_error,
    import_note,
    replay_error,
    goal: |wish| {
        let mut parts = Vec::new();
        parts.extend(wish.route.map(|route| match route {
            Route::Squeeze => "まるごと".to_string(),
            Route::Shave => "けずる".to_string(),
            Route::Mix => "けずっておしこむ".to_string(),
        }));
        parts.extend(wish.seconds.map(|most| format!("{most}秒")));
        parts.extend(
            wish.kept
                .map(|least| format!("ちぎるのは{}％まで", percent_of_limit(1.0 - least))),
        );
        parts.extend(match (wish.pieces, wish.max_pieces) {
            (None, None) => None,
            (_, Some(1)) => Some("ちぎらない".into()),
            (Some(least), None) => Some(format!("{least}こ")),
            (Some(least), Some(most)) if least == most => Some(format!("{least}こちょうど")),
            (Some(least), Some(most)) => Some(format!("{least}〜{most}こ")),
            (None, Some(most)) => Some(format!("{most}こまで")),
        });
        parts.extend(wish.joints.map(|joints| match joints {
            Joints::Whole => "つなぎ目を切らない".to_string(),
            Joints::Broken => "つなぎ目を切る".to_string(),
        }));
        if !wish.whole.is_empty() {
            parts.push("こわれものを こわさない".to_string());
        }
        parts.extend(
            wish.inside
                .map(|least| format!("{}％以上入れる", percent_of_limit(least))),
        );
        parts.join("・")
    },
    share: |found, needed| format!("{}／{}％", percent_below(found), percent_of_limit(needed)),
    share_in_basket: |found, needed| {
        let found = percent_below(found);
        format!("かごの中：{found}％（目標 {}％）", percent_of_limit(needed))
    },
    near_miss: |wish, outcome| {
        let missed = outcome.misses(wish);
        let parts = [
            missed
                .seconds
                .map(|_| format!("{}だった", time(outcome.seconds()))),
            missed
                .kept
                .map(|_| format!("{}％ ちぎれた", percent_lost(outcome))),
            { missed.pieces.or(missed.max_pieces) }.map(|_| format!("{}こだった", outcome.pieces)),
            missed.joints.map(|joints| match joints {
                Joints::Whole => "つなぎ目が切れた".to_string(),
                Joints::Broken => "つなぎ目は切れなかった".to_string(),
            }),
            (!missed.whole.is_empty()).then(|| "こわれた".to_string()),
            { missed.inside }.map(|_| format!("{}％だった", percent_below(outcome.inside))),
            missed.route.map(|_| match outcome.route {
                Route::Squeeze => "まるごと入った".to_string(),
                Route::Shave => "けずって入れた".to_string(),
                Route::Mix => "けずって おしこんだ".to_string(),
            }),
        ];
        let parts: Vec<String> = parts.into_iter().flatten().collect();
        (!parts.is_empty()).then(|| parts.join("・"))
    },
    quality: "画質",
    quality_name: |quality| match quality {
        Quality::Automatic => "自動",
        Quality::High => "高",
        Quality::Medium => "中",
        Quality::Low => "低",
    },
    quality_lowered: "動きがなめらかになるように、画質を下げました。設定で変えられます。",
    drawing_slow: "動きが なめらかではありません。設定で画質を下げるか、ウィンドウを小さくすると、なめらかになります。",
    two_players: "ふたりであそぶ",
    who_plays: |[arrows, letters]| {
        [
            format!("ひとつめの手：マウス、または {arrows}"),
            format!("ふたつめの手：{letters}"),
            "スティックやパッド：「ふたりで」のボタンで ふたつめの手を動かせます。".into(),
            "タッチスクリーン：2Dのステージで ふたつの点をおすと、もう一本の指で ふたつめの手を動かせます。"
                .into(),
        ]
    },
    play_as_two: "ふたりで はじめる",
    play_alone: "ひとりで あそぶ",
    no_arrow_keys: "ひとりめの人の矢印キーが たりません。設定の「操作」でえらんでください。",
    no_letter_keys: "ふたりめの人の文字キーが たりません。設定の「操作」でえらんでください。",
    count: |number| {
        const NAMES: [&str; 10] = [
            "ひとつ",
            "ふたつ",
            "みっつ",
            "よっつ",
            "いつつ",
            "むっつ",
            "ななつ",
            "やっつ",
            "ここのつ",
            "とお",
        ];
        let name = number.checked_sub(1).and_then(|index| NAMES.get(index));
        name.map_or(format!("{number}！"), |name| format!("{name}！"))
    },
    thanks: |levels, earned, all| {
        let first = match earned == all {
            true => format!("{levels}ステージ、星も ぜんぶ！ もう ちぎる ものが ないよ。"),
            false => format!("{levels}ステージ、星は {all}こ中 {earned}こ。"),
        };
        [first, "あそんでくれて ありがとう！".to_string()]
    },
    ending: "エンディング",
    elements_caption: |colour| match colour {
        ElementColour::Level => {
            "体は ブロックで できている。ふちは ちいさく、なかは おおきい。ちぎれる ところは、ちいさな ブロックに かわる。"
        }
        ElementColour::Strain => {
            "あおい ところは らく、きいろい ところは ひっぱられている。むりが かかりすぎると ちぎれる。"
        }
    },
    stuff: |stuff| match stuff {
        Stuff::Jelly => "ゼリー",
        Stuff::Rubber => "ゴム",
        Stuff::Biscuit => "ビスケット",
        Stuff::Clay => "ねんど",
        Stuff::Stone => "石",
        Stuff::Caramel => "キャラメル",
        Stuff::Dough => "パン生地",
    },
    add_form: |form| match form {
        Form::Ball | Form::Empty => "ボールを だす",
        Form::Box => "はこを だす",
        Form::Ring => "わっかを だす",
        Form::Heart => "ハートを だす",
        Form::Flower => "花を だす",
    },
    tool: |tool| match tool {
        Tool::Push => "おす",
        Tool::Grab => "つかむ：おしている あいだ",
        Tool::Knife => "ナイフ：おしている あいだ",
        Tool::Pin => "ピン：おす",
    },
    sliders: "重力・空気・手",
    clear: "ぜんぶ かたづける",
    tools: "どうぐ",
    material: "そざい",
    hand_tool: "手",
    gravity: "重力［m/s²］",
    air: "空気抵抗［1/s］",
    hand_size: "手の半径［cm］",
    room_is_full: "部屋が いっぱいです。",
    too_many_pins: "もう ピンを させないよ。かたづけるか、まきもどしてね。",
    too_many_changes: "いちどに かえすぎたよ。つづけるか、さいしょからやってね。",
    first_move: "おばけが さいしょの うごきを みせるよ。",
    one_hand: "このステージの手は ひとつだけなので、ひとりであそびます。",
};

/// Returns a time in seconds, rounded up to tenths.
fn time(seconds: f32) -> String {
    format!("{:.1}秒", tenths_above(seconds))
}

fn import_note(note: &ImportNote) -> String {
    let file = &note.file;
    match note.kind {
        NoteKind::HiddenModels { left_out } => {
            format!("{file}：かくしてある部分（{left_out}こ）は使いませんでした。")
        }
        NoteKind::UnplacedModels { left_out } => {
            format!(
                "{file}：MagicaVoxelのワールドに置かれていない部分（{left_out}こ）は使いませんでした。"
            )
        }
        NoteKind::Frames { .. } => {
            format!("{file} はアニメーションなので、さいしょの絵だけを使いました。")
        }
        NoteKind::Overlap { voxels } => {
            format!("{file}：色のちがう部分が、キューブ{voxels}こ分 重なっています。")
        }
        NoteKind::Pieces { pieces, touch } => {
            let how = if touch {
                "ふちや かどだけで ふれている所は、はなれます。"
            } else {
                ""
            };
            format!("{file} は{pieces}つに分かれます。{how}")
        }
        NoteKind::Surroundings { .. } => {
            format!("{file}：絵のふちにあるものは使いませんでした。")
        }
        NoteKind::Specks { .. } => format!("{file}：小さな点は使いませんでした。"),
        _ => note.to_string(),
    }
}

/// Error text in Japanese. Details that name fields and lines of files are not translated.
fn level_error(error: &LevelError) -> String {
    match error {
        LevelError::Unreadable(file, reason) => format!("読めませんでした。{file}: {reason}"),
        LevelError::Scene(scene) => format!("このステージは読めませんでした。{scene}"),
        LevelError::NoBody(reason) => {
            format!("このファイルからは体を作れませんでした。{reason}")
        }
        LevelError::NoGame { id, field, reason } => {
            format!("「{id}」は、このままでは あそべません。{field}: {reason}")
        }
        LevelError::Unknown { id, .. } => {
            format!("「{id}」というステージはありません。")
        }
        LevelError::Missing { id, .. } => {
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
            "このリプレイは書きかえられています。結果がちがいます。".into()
        }
    }
}

fn link_error(error: &LinkError) -> String {
    match error {
        LinkError::Other => "これは tamaire のリンクではありません。".into(),
        LinkError::Newer => "新しいバージョンの tamaire で作られたリンクです。".into(),
        LinkError::CutShort => "リンクが とちゅうで切れています。".into(),
        LinkError::Damaged => "リンクがこわれているか、全部とどいていません。".into(),
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
    fn errors_are_translated_and_keep_their_details() {
        let unknown = level_error(&Level::open("nowhere").unwrap_err());
        assert!(unknown.contains("nowhere") && unknown.contains("ありません"));
        let refused = |name: &str, bytes: &str| {
            let nothing = |_: &str| Err(std::io::ErrorKind::NotFound.into());
            level_error(&Level::read(name, bytes.as_bytes(), &nothing).unwrap_err())
        };
        let broken = refused("a.toml", "dim = 2\ngravity = \"down\"\n");
        assert!(broken.contains("読めません") && broken.contains("line 2"));
        let model = refused("a.vox", "VOX ");
        assert!(model.contains("体を作れませんでした。a.vox"), "{model}");
        let old = replay_error(&ReplayError::Version { found: 7 });
        assert!(old.contains("バージョン（7）"), "{old}");
    }
}
