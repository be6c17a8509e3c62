//! 日本語

use super::{Plot, Reading, Words, busiest, halves_and_dust, once_and_often, percent, sure};
use crate::figures::{Basis, Dares, Figures, Reason, Switching};
use crate::plot::grouped;
use crate::reading::{Strategies, Unexplained, won_again};
use tamaire_play::Route;

/// What the page says in Japanese.
pub static JAPANESE: Words = Words {
    code: "ja",
    title: "来場者のあそび方",
    days: |figures| match (figures.first_day, figures.last_day) {
        (Some(first), Some(last)) if first == last => first.to_string(),
        (Some(first), Some(last)) => {
            format!("{first} から {last} まで（{}日）", figures.days.len())
        }
        _ => String::new(),
    },
    nothing: "この期間の記録には、まだ来場者がいません。お見せできるものはありません。",
    numbers: [
        "来場（組）",
        "ラウンド",
        "勝てた来場の割合",
        "はじめて勝つまでの時間（中央値）",
    ],
    of: |some, all| format!("{}組のうち {}組", grouped(all), grouped(some)),
    none: "–",
    time,
    parts: ["押し込み", "削り", "両方", "勝たずに終わった"],
    route,
    tries: ["1回目", "2回目", "3回目", "4回目から後"],
    rounds: |count| format!("{}ラウンド", grouped(count)),
    reading: Reading {
        title: "2004年に見られたこと、ここで見られたこと",
        then: "2004年のメディア祭では、「3つの棒に囲まれた領域の中に入れる」ということだけを伝えて、遊んでもらいました。すると操作は\
            大きく2つに分かれました。壊さないように変形させて押し込む方法と、入る大きさまで削る方法です。片方で成功したあと、もう片方を\
            試す人も多くいました。",
        strategies,
        unexplained,
        switching: reading_of_switching,
        unknown: "そばで誰かが説明したかどうか、同じ人が二度来たかどうかは、記録からはわかりません。ゲームは、はじめに うすい手の絵を\
            見せ、勝ったあとに もう一つの方法をすすめることがあります。",
    },
    hours: Plot {
        title: "いつ来たか",
        axes: ["時刻（展示場所の時間）［時］", "数"],
        caption: |figures| {
            let most = busiest(figures).map(|(hour, visits)| {
                format!(
                    "来場がいちばん多かったのは {hour}時台で、{}組でした。",
                    grouped(visits)
                )
            });
            format!(
                "来場とラウンドを、始まった時刻で数えました。{}",
                most.unwrap_or_default()
            )
        },
    },
    hour_series: ["来場", "ラウンド"],
    by_level: Plot {
        title: "ステージごとの結果",
        axes: ["ラウンドに占める割合［％］", ""],
        caption: "一本の帯が、一つのステージの全ラウンドです。ラウンドの多い順に並んでいます。おたすけを使ったステージや、\
            ちがう版のステージは、名前のうしろに4けたの番号がついています。",
    },
    by_try: Plot {
        title: "何回目かによる結果",
        axes: ["ラウンドに占める割合［％］", ""],
        caption: "同じ結果を、その来場の何回目のラウンドだったかで分けました。慣れると、「勝たずに終わった」が減っていきます。",
    },
    first_win: Plot {
        title: "はじめて勝つまでの時間",
        axes: ["はじめて勝つまでに遊んだ時間［秒］", "来場（組）"],
        caption: |figures| {
            let quantiles = figures.to_first_win.quantiles.unwrap_or_default();
            let rest = figures.total.visits - figures.to_first_win.visits;
            format!(
                "はじめて勝つまでに遊んだ時間ごとの組数です。右はしは、それより長くかかった全部です。勝った組の半分は{}以内、\
                 10組のうち9組は{}以内に勝ちました。一度も勝たなかった{}組は、入っていません。",
                time(quantiles[2]),
                time(quantiles[4]),
                grouped(rest),
            )
        },
    },
    median: |seconds| format!("中央値 {}", time(seconds)),
    per_visit: Plot {
        title: "一度の来場で遊んだ回数",
        axes: ["ラウンドの数［回］", "来場（組）"],
        caption: |figures| {
            let [once, often] = once_and_often(figures);
            let all = figures.total.visits;
            format!(
                "勝ち負けにかかわらず、何ラウンド遊んだかです。1回だけが{}％、2回以上が{}％でした。",
                percent(once, all),
                percent(often, all),
            )
        },
    },
    switching: Plot {
        title: "次は別の方法で？",
        axes: ["これらの来場に占める割合［％］", ""],
        caption: |switching: &Switching| {
            format!(
                "はじめて勝った方法ごとに、次に勝った方法で分けました。{}組が、次は別の方法で勝ちました。そのうち{}組は、\
                 ゲームにすすめられていませんでした。",
                grouped(switching.switched),
                grouped(switching.switched_undared),
            )
        },
    },
    after: |first, visits| format!("はじめの勝ち：{}（{}組）", route(first), grouped(visits)),
    no_more: "その後は勝っていない",
    dares: Plot {
        title: "すすめられた方法を試したか",
        axes: ["すすめられたラウンドに占める割合［％］", ""],
        caption: |dares: &Dares| {
            format!(
                "もう一つの方法をすすめられたラウンドです。すすめられたのは{}組、そのとおりに勝ったのは{}組でした。",
                grouped(dares.visits),
                grouped(dares.visits_as_dared),
            )
        },
    },
    dare_parts: [
        "すすめどおりに勝った",
        "別の方法で勝った",
        "勝たずに終わった",
    ],
    pieces: Plot {
        title: "終わったときの かけらの数",
        axes: ["かけらの数［個まで］", "ラウンド"],
        caption: |figures| {
            let [halves, dust] = halves_and_dust(figures);
            format!(
                "ラウンドの終わりに、いくつに分かれていたかです。ちょうど2つが{}ラウンド、128個より細かい粉々が{}ラウンドでした。",
                grouped(halves),
                grouped(dust),
            )
        },
    },
    hands: Plot {
        title: "手が動いた場所",
        axes: ["左右［m］", "高さ［m］"],
        caption: |rounds, most, wide| {
            format!(
                "色がこいほど、手が長くいた場所です。いちばんこいところで、{wide:.0} cm四方に、1ラウンドあたり{most:.2}秒。白いところには来て\
                 いません。細い線は始まりの玉、太い線はかご、茶色は棒や台です。もう一度動かした{}ラウンド分です。",
                grouped(rounds),
            )
        },
    },
    from_above: ["奥行き、下が手前［m］", "上から見た図です。"],
    no_hands: "手が動いた場所は出していません。ラウンドをもう一度動かす必要があります。--rerun をつけて作りなおすと出ます。\
        そのとき、どのラウンドも記録どおりになるかを確かめます。",
    best: Plot {
        title: "いちばん速かったラウンド",
        axes: ["", ""],
        caption: "それぞれの日に、それぞれの方法でいちばん速かった勝ちです。動画は最後の日のものです。",
    },
    best_columns: ["日", "方法", "ステージ", "時間", "展示"],
    no_clip: "動画がないもの：",
    tables: [
        "展示ごと",
        "日ごと",
        "表示された ことば",
        "展示で起きたこと",
    ],
    columns: [
        "来場",
        "ラウンド",
        "勝てた来場",
        "はじめて勝つまで（中央値）",
    ],
    more: |count| format!("ほか{count}件は report.json にあります"),
    language: |code| match code {
        "en" => Some("英語"),
        "ja" => Some("日本語"),
        "de" => Some("ドイツ語"),
        "fr" => Some("フランス語"),
        "zh" => Some("中国語"),
        "ko" => Some("韓国語"),
        "es" => Some("スペイン語"),
        "" => Some("不明"),
        _ => None,
    },
    event: |kind| match kind {
        "began" => Some("プログラムが始まった"),
        "ended" => Some("プログラムが正しく終わった"),
        "crashed" => Some("プログラムが壊れて止まった"),
        "hung" => Some("プログラムが固まり、始めなおした"),
        "lost_graphics" => Some("GPUかウィンドウが失われた"),
        "gave_up" => Some("プログラムの始めなおしをやめた"),
        "full_disk" => Some("ディスクがいっぱいになった"),
        "damaged_file" => Some("壊れたファイルを別に移した"),
        "clock_changed" => Some("時計が合わせなおされた"),
        "device_lost" => Some("スティックかパッドが抜けた"),
        "device_found" => Some("スティックかパッドがつながった"),
        "staff_in" => Some("係の画面が開かれた"),
        "staff_refused" => Some("係の画面を開こうとして断られた"),
        "settings_changed" => Some("設定が変わった"),
        _ => None,
    },
    basis: ("この数字のもと", basis),
    refused: |count| format!("次の{count}ラウンドは、どこにも数えていません。"),
    reason: |reason| match reason {
        Reason::Contradictory => "書かれたことが食いちがう",
        Reason::Unreadable => "読めない",
        Reason::Astray => "もう一度動かすと別の道をたどる",
        Reason::Differs => "記録とちがう終わり方をする",
    },
    foot: "tamaire が記録から作りました。記録には、誰だったかについて何も入っていません。",
};

fn route(route: Route) -> &'static str {
    match route {
        Route::Squeeze => "押し込み",
        Route::Shave => "削り",
        Route::Mix => "両方",
    }
}

fn time(seconds: f64) -> String {
    match seconds {
        s if s < 9.95 => format!("{s:.1}秒"),
        s if s < 119.5 => format!("{s:.0}秒"),
        s => format!("{}分{:02}秒", s.round() as u64 / 60, s.round() as u64 % 60),
    }
}

fn strategies(strategies: Strategies, figures: &Figures) -> String {
    let wins = figures.total.rounds;
    let [squeeze, shave, mix] =
        [wins.squeeze, wins.shave, wins.mix].map(|k| percent(k, wins.won()));
    let all = format!("{}回の勝ち", grouped(wins.won()));
    match strategies {
        Strategies::Few => format!(
            "どの方法が現れるかは、まだわかりません。勝ちは{}回で、20回ほどは必要です。",
            grouped(wins.won()),
        ),
        Strategies::Both => format!(
            "ここでも2つの方法が現れました。{all}のうち、押し込みが{squeeze}％、削りが{shave}％、両方が{mix}％でした。"
        ),
        Strategies::Only(Route::Squeeze) => format!(
            "現れたのは片方だけでした。{all}のうち、押し込みが{squeeze}％で、削りはほとんどなく{shave}％でした（両方は{mix}％）。"
        ),
        Strategies::Only(Route::Shave) => format!(
            "現れたのは片方だけでした。{all}のうち、削りが{shave}％で、押し込みはほとんどなく{squeeze}％でした（両方は{mix}％）。"
        ),
        Strategies::Only(Route::Mix) => format!(
            "2つの方法は、はっきり分かれませんでした。{all}のうち、両方が{mix}％、押し込みが{squeeze}％、削りが{shave}％でした。"
        ),
    }
}

fn unexplained(unexplained: Unexplained, figures: &Figures) -> String {
    let total = &figures.total;
    let [share, low, high] = sure(total.visits_won, total.visits);
    let seen = format!(
        "{}組のうち{}組が勝ちました。{share}％です（95％信頼区間 {low}～{high}％）。",
        grouped(total.visits),
        grouped(total.visits_won),
    );
    let soon = total
        .median_to_first_win
        .map(|median| format!("勝った組の半分は、{}までに勝っていました。", time(median)));
    let soon = soon.unwrap_or_default();
    match unexplained {
        Unexplained::Few => format!("説明がいるかどうかは、まだわかりません。{seen}"),
        Unexplained::Most => format!("説明はいらなかったようです。{seen}{soon}"),
        Unexplained::Half => format!(
            "説明がいらなかったかどうかは、決められません。{seen}半分をこえるかどうかは、はっきりしません。{soon}"
        ),
        Unexplained::Minority => format!(
            "説明はいらなかった、とは言えません。{seen}多くの組は、勝たずに終わりました。{soon}"
        ),
    }
}

fn reading_of_switching(is_known: bool, figures: &Figures) -> String {
    let (again, switching) = (won_again(figures), &figures.switching);
    if !is_known {
        return format!(
            "もう一つの方法を試すかどうかは、まだわかりません。2回以上勝ったのは{}組です。",
            grouped(again)
        );
    }
    let switched = switching.switched;
    format!(
        "2回以上勝った{}組のうち、{}組（{}％）は、2回目に別の方法で勝ちました。そのうち{}組は、あいだにゲームからすすめられて\
         いませんでした。",
        grouped(again),
        grouped(switched),
        percent(switched, again),
        grouped(switching.switched_undared),
    )
}

fn basis(basis: &Basis) -> Vec<String> {
    let mut said = vec![format!(
        "記録ファイルは{}個です。「来場」は、展示が客を待っているあいだから次に待つまでの、ひとまとまりです。展示場所の時間で、始まった日に\
         数え、その中のラウンドもすべてその日に入れます。",
        grouped(basis.files),
    )];
    let mut say = |count: u64, text: String| {
        if count > 0 {
            said.push(text);
        }
    };
    let count = basis.repeated_rows;
    say(
        count,
        format!(
            "同じ行が{}回くりかえされていましたが、一度だけ数えました。",
            grouped(count)
        ),
    );
    let count = basis.visits_without_end;
    say(
        count,
        format!(
            "終わりのない来場が{}組あります。停電や故障で切れたか、まだ続いています。",
            grouped(count)
        ),
    );
    let count = basis.visits_with_clock_back;
    say(
        count,
        format!(
            "{}組のあいだに、時計が戻りました。時刻と日は時計どおりに、ほかはラウンドの順番どおりに数えています。",
            grouped(count)
        ),
    );
    if basis.is_rerun {
        said.push(format!(
            "{}ラウンドをもう一度動かし、記録どおりになりました。",
            grouped(basis.rerun)
        ));
        if basis.not_rerun > 0 {
            said.push(format!(
                "{}ラウンドは、リプレイがない、ルールがちがう、知らないステージなどで動かせず、確かめずに数えました。",
                grouped(basis.not_rerun),
            ));
        }
    } else {
        said.push(
            "ラウンドをもう一度動かしてはいません。記録どおりになるかは、確かめていません。".into(),
        );
    }
    said
}
