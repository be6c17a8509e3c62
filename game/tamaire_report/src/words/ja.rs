//! Japanese (日本語).

use super::{Plot, Reading, Words, busiest, halves_and_dust, once_and_often, percent, sure};
use crate::comparison_2004::{Strategies, Unexplained, won_again};
use crate::figures::{Basis, Dares, Figures, Reason, Switching};
use crate::plot::grouped;
use tamaire_play::Route;

/// Texts of the page in Japanese.
pub static JAPANESE: Words = Words {
    code: "ja",
    title: "来場者レポート",
    days: |figures| match (figures.first_day, figures.last_day) {
        (Some(first), Some(last)) if first == last => first.to_string(),
        (Some(first), Some(last)) => {
            format!("{first} から {last} まで（{}日）", figures.days.len())
        }
        _ => String::new(),
    },
    nothing: "この期間には来場の記録がありません。まだ表示できるものはありません。",
    numbers: [
        "来場（組）",
        "ラウンド",
        "クリアした来場の割合",
        "初クリアまでの時間（中央値）",
    ],
    of: |some, all| format!("{}組のうち {}組", grouped(all), grouped(some)),
    none: "–",
    time,
    parts: ["押し込み", "削り", "両方", "クリアせず"],
    route,
    tries: ["1回目", "2回目", "3回目", "4回目以降"],
    rounds: |count| format!("{}ラウンド", grouped(count)),
    level_rounds: |count, tries| match tries {
        Some(tries) => format!("{}ラウンド、クリア1回に{tries:.1}", grouped(count)),
        None => format!("{}ラウンド、クリアなし", grouped(count)),
    },
    reading: Reading {
        title: "2004年との比較",
        then: "2004年のメディア祭では、「3本の棒に囲まれた領域の中に入れる」とだけ伝えて、遊んでもらいました。すると操作は\
            大きく2つに分かれました。壊さないように変形させて押し込む方法と、入る大きさまで削る方法です。片方で成功したあと、もう片方を\
            試す人も多くいました。",
        strategies,
        unexplained,
        switching: reading_of_switching,
        unknown: "そばで誰かが説明したかどうか、同じ人が2度来たかどうかは、記録からはわかりません。ゲームは、はじめに薄い手の絵を\
            見せ、クリアの後にもう一つの方法をすすめることがあります。",
    },
    hours: Plot {
        title: "時間帯ごとの来場",
        axes: ["時刻（展示場所の時間）［時］", "数"],
        caption: |figures| {
            let most = busiest(figures).map(|(hours, visits)| {
                let each = if hours.len() > 1 { "それぞれ" } else { "" };
                let hours: Vec<String> = hours.iter().map(|hour| format!("{hour}時台")).collect();
                format!(
                    "来場が最も多かったのは{}で、{each}{}組でした。",
                    hours.join(if hours.len() > 2 { "、" } else { "と" }),
                    grouped(visits)
                )
            });
            format!(
                "始まった時刻ごとの来場とラウンドの数です。{}",
                most.unwrap_or_default()
            )
        },
    },
    hour_series: ["来場", "ラウンド"],
    by_level: Plot {
        title: "ステージごとの結果",
        axes: ["ラウンドに占める割合［％］", ""],
        caption: "1本の帯が、1つのステージの全ラウンドです。かっこの中は、全ラウンドの数と、クリア1回あたりのラウンドの数です。ラウンドの多い順に並んでいます。おたすけを使ったステージや、\
            版の違うステージには、名前の後に4桁の番号がついています。",
    },
    by_try: Plot {
        title: "何回目かによる結果",
        axes: ["ラウンドに占める割合［％］", ""],
        caption: "同じ結果を、その来場の何回目のラウンドだったかで分けました。慣れると、「クリアせず」が減っていきます。",
    },
    first_win: Plot {
        title: "初クリアまでの時間",
        axes: ["初クリアまでに遊んだ時間［秒］", "来場（組）"],
        caption: |figures| {
            let quantiles = figures.to_first_win.quantiles.unwrap_or_default();
            let rest = figures.total.visits - figures.to_first_win.visits;
            format!(
                "初クリアまでに遊んだ時間ごとの組数です。右端は、それより長くかかったすべてです。クリアした組の半分は{}以内、\
                 10組のうち9組は{}以内でした。一度もクリアしなかった{}組は含みません。",
                time(quantiles[2]),
                time(quantiles[4]),
                grouped(rest),
            )
        },
    },
    median: |seconds| format!("中央値 {}", time(seconds)),
    per_visit: Plot {
        title: "1回の来場で遊んだ回数",
        axes: ["ラウンドの数［回］", "来場（組）"],
        caption: |figures| {
            let [once, often] = once_and_often(figures);
            let all = figures.total.visits;
            format!(
                "クリアしたかどうかにかかわらず、遊んだラウンドの数です。1回だけが{}％、2回以上が{}％でした。",
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
                "初クリアの方法ごとに、次のクリアの方法で分けました。{}組が、次は別の方法でクリアしました。そのうち{}組は、\
                 ゲームにすすめられていませんでした。",
                grouped(switching.switched),
                grouped(switching.switched_undared),
            )
        },
    },
    after: |first, visits| format!("初クリア：{}（{}組）", route(first), grouped(visits)),
    no_more: "その後のクリアなし",
    dares: Plot {
        title: "すすめられた方法を試したか",
        axes: ["すすめられたラウンドに占める割合［％］", ""],
        caption: |dares: &Dares| {
            format!(
                "もう一つの方法をすすめられたラウンドです。すすめられたのは{}組、そのとおりにクリアしたのは{}組でした。",
                grouped(dares.visits),
                grouped(dares.visits_as_dared),
            )
        },
    },
    dare_parts: ["すすめられた方法でクリア", "別の方法でクリア", "クリアせず"],
    pieces: Plot {
        title: "終了時のかけらの数",
        axes: ["かけらの数［個以下］", "ラウンド"],
        caption: |figures| {
            let [halves, dust] = halves_and_dust(figures);
            format!(
                "ラウンドの終わりに、いくつに分かれていたかです。ちょうど2個が{}ラウンド、128個を超えたのが{}ラウンドでした。",
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
                "色が濃いほど、手が長くあった場所です。最も濃いところで、{wide:.0} cm四方に1ラウンドあたり{most:.2}秒です。白いところには手が来て\
                 いません。細い線は開始時の体、太い線はかご、茶色は棒や台です。再生して調べた{}ラウンド分です。",
                grouped(rounds),
            )
        },
    },
    from_above: ["奥行き、下が手前［m］", "上から見た図です。"],
    no_hands: "手が動いた場所を表示するには、ラウンドを再生して調べる必要があります。--rerun をつけてレポートを作り直してください。\
        すべてのラウンドが記録どおりの結果になるかも確認します。",
    best: Plot {
        title: "最速のラウンド",
        axes: ["", ""],
        caption: "日ごと、方法ごとに最も速かったクリアです。動画は最後の日のものです。",
    },
    best_columns: ["日", "方法", "ステージ", "時間", "展示"],
    no_clip: "動画のないラウンド：",
    tables: ["展示ごと", "日ごと", "表示した言語", "展示での出来事"],
    columns: [
        "来場",
        "ラウンド",
        "クリアした来場",
        "初クリアまで（中央値）",
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
        "began" => Some("プログラムの起動"),
        "ended" => Some("プログラムの正常終了"),
        "crashed" => Some("プログラムの異常終了"),
        "hung" => Some("プログラムの応答停止と再起動"),
        "lost_graphics" => Some("GPUまたはウィンドウの消失"),
        "gave_up" => Some("故障中：再起動の中止"),
        "full_disk" => Some("ディスクの空き不足"),
        "damaged_file" => Some("壊れたファイルの退避"),
        "clock_changed" => Some("時計の変更"),
        "device_lost" => Some("スティックまたはゲームパッドの取り外し"),
        "device_found" => Some("スティックまたはゲームパッドの接続"),
        "staff_in" => Some("スタッフ画面の表示"),
        "staff_refused" => Some("スタッフ画面でのPINの間違い"),
        "settings_changed" => Some("設定の変更"),
        _ => None,
    },
    basis: ("この集計について", basis),
    refused: |count| format!("次の{count}ラウンドは集計に含みません。"),
    reason: |reason| match reason {
        Reason::Contradictory => "記録が矛盾している",
        Reason::Unreadable => "リプレイを読めない",
        Reason::Astray => "リプレイが途中で記録と食い違う",
        Reason::Differs => "リプレイの結果が記録と違う",
    },
    foot: "tamaire が記録から作成しました。記録には、来場者を特定できる情報は含まれていません。",
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
    let all = format!("{}回のクリア", grouped(wins.won()));
    match strategies {
        Strategies::Few => format!(
            "どの方法が現れるかは、まだわかりません。クリアは{}回で、20回ほど必要です。",
            grouped(wins.won()),
        ),
        Strategies::Both => format!(
            "ここでも2つの方法が現れました。{all}のうち、押し込みが{squeeze}％、削りが{shave}％、両方が{mix}％でした。"
        ),
        Strategies::Only(Route::Squeeze) => format!(
            "現れたのは片方だけでした。{all}のうち、押し込みが{squeeze}％で、削りは{shave}％だけでした（両方は{mix}％）。"
        ),
        Strategies::Only(Route::Shave) => format!(
            "現れたのは片方だけでした。{all}のうち、削りが{shave}％で、押し込みは{squeeze}％だけでした（両方は{mix}％）。"
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
        "{}組のうち{}組がクリアしました。{share}％です（95％信頼区間 {low}～{high}％）。",
        grouped(total.visits),
        grouped(total.visits_won),
    );
    let soon = total
        .median_to_first_win
        .map(|median| format!("初クリアまでの時間の中央値は{}です。", time(median)));
    let soon = soon.unwrap_or_default();
    match unexplained {
        Unexplained::Few => format!("説明が必要かどうかは、まだわかりません。{seen}"),
        Unexplained::Most => format!("説明は必要なかったようです。{seen}{soon}"),
        Unexplained::Half => format!(
            "説明が必要だったかどうかは、はっきりしません。{seen}半分を超えるかどうかは、まだ言えません。{soon}"
        ),
        Unexplained::Minority => format!(
            "説明が必要なかったとは言えません。{seen}多くの組は、クリアせずに終わりました。{soon}"
        ),
    }
}

fn reading_of_switching(is_known: bool, figures: &Figures) -> String {
    let (again, switching) = (won_again(figures), &figures.switching);
    if !is_known {
        return format!(
            "もう一つの方法を試すかどうかは、まだわかりません。2回以上クリアしたのは{}組です。",
            grouped(again)
        );
    }
    let switched = switching.switched;
    format!(
        "2回以上クリアした{}組のうち、{}組（{}％）は、2回目に別の方法でクリアしました。そのうち{}組は、その間にゲームからすすめられて\
         いませんでした。",
        grouped(again),
        grouped(switched),
        percent(switched, again),
        grouped(switching.switched_undared),
    )
}

fn basis(basis: &Basis) -> Vec<String> {
    let mut said = vec![format!(
        "記録ファイルは{}個です。「来場」は、最初に触れてから展示が待ち受けに戻るまでです。展示場所の時間で始まった日に\
         数え、その中のラウンドもすべてその日に含めます。",
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
            "重複した行が{}行ありましたが、1度だけ数えました。",
            grouped(count)
        ),
    );
    let count = basis.visits_without_end;
    say(
        count,
        format!(
            "終了の記録がない来場が{}組あります。停電や故障で中断したか、まだ続いています。",
            grouped(count)
        ),
    );
    let count = basis.visits_with_clock_back;
    say(
        count,
        format!(
            "{}組の来場中に、時計が戻りました。時刻と日は時計のとおりに、ほかはラウンドの順に数えています。",
            grouped(count)
        ),
    );
    if basis.is_rerun {
        said.push(format!(
            "{}ラウンドを再生し、記録どおりの結果になりました。",
            grouped(basis.rerun)
        ));
        if basis.not_rerun > 0 {
            said.push(format!(
                "{}ラウンドは、リプレイがない、ルールが違う、ステージが未知などの理由で再生できず、確認せずに数えました。",
                grouped(basis.not_rerun),
            ));
        }
    } else {
        said.push(
            "ラウンドを再生していないため、記録どおりの結果になるかは確認していません。".into(),
        );
    }
    said
}
