//! English

use super::{Plot, Reading, Words, busiest, halves_and_dust, once_and_often, percent, sure};
use crate::figures::{Basis, Dares, Figures, Reason, Switching};
use crate::plot::grouped;
use crate::reading::{Strategies, Unexplained, won_again};
use tamaire_play::Route;

/// What the page says in English.
pub static ENGLISH: Words = Words {
    code: "en",
    title: "What visitors did",
    days: |figures| match (figures.first_day, figures.last_day) {
        (Some(first), Some(last)) if first == last => first.to_string(),
        (Some(first), Some(last)) => format!(
            "{first} to {last}, {}",
            plural(figures.days.len() as u64, "day")
        ),
        _ => String::new(),
    },
    nothing: "There is no visit in these logbooks in the days that were asked for. So there is nothing to show yet.",
    numbers: [
        "visits",
        "rounds",
        "of all visits won",
        "median time to the first win",
    ],
    of: |some, all| format!("{} of {}", grouped(some), grouped(all)),
    none: "–",
    time,
    parts: [
        "squeezed in whole",
        "shaved to fit",
        "some of both",
        "not won",
    ],
    route,
    tries: ["1st round", "2nd round", "3rd round", "4th round and later"],
    rounds: |count| plural(count, "round"),
    reading: Reading {
        title: "What was seen in 2004, and what is seen here",
        then: "In 2004 people at a media festival were told no more than to put the body into the region between three bars. \
            Two strategies appeared: to squeeze it in without breaking it, and to shave it down until it fitted. Many who had \
            won one way then tried the other.",
        strategies,
        unexplained,
        switching: reading_of_switching,
        unknown: "Logbooks do not know whether somebody stood by and explained, or whether two visits were of the same \
            person. The game itself shows a pale hand at first, and may suggest the other way after a win.",
    },
    hours: Plot {
        title: "When people came",
        axes: ["hour of the day, local time of the stand", "number"],
        caption: |figures| {
            let most = busiest(figures);
            let most = most.map(|(hour, visits)| {
                format!(
                    " Most visits, {}, began between {hour}:00 and {}:00.",
                    grouped(visits),
                    hour + 1
                )
            });
            format!(
                "Visits and rounds by the hour in which they began.{}",
                most.unwrap_or_default()
            )
        },
    },
    hour_series: ["visits", "rounds"],
    by_level: Plot {
        title: "How rounds ended, by level",
        axes: ["share of the level's rounds [%]", ""],
        caption: "Each bar is all rounds of a level, parted by how they ended. The level with most rounds comes first. A level \
            that was made easier, or that is another version, has four digits behind its name.",
    },
    by_try: Plot {
        title: "How rounds ended, by try",
        axes: ["share of these rounds [%]", ""],
        caption: "The same by whether it was the first, second or third round of a visit, or a later one. What people learn \
            shows as less that is not won from bar to bar.",
    },
    first_win: Plot {
        title: "How long it took to win",
        axes: ["time played up to the first win [s]", "visits"],
        caption: |figures| {
            let quantiles = figures.to_first_win.quantiles.unwrap_or_default();
            let rest = figures.total.visits - figures.to_first_win.visits;
            format!(
                "Visits by how long they had played when they first won; the last column is all that took longer. Half of those \
                 who won did it within {}, nine of ten within {}. {} never won and {} not in the plot.",
                time(quantiles[2]),
                time(quantiles[4]),
                plural(rest, "visit"),
                if rest == 1 { "is" } else { "are" },
            )
        },
    },
    median: |seconds| format!("median {}", time(seconds)),
    per_visit: Plot {
        title: "Rounds in a visit",
        axes: ["rounds in a visit", "visits"],
        caption: |figures| {
            let [once, often] = once_and_often(figures);
            let all = figures.total.visits;
            format!(
                "Visits by how many rounds they had, won or not. {}% played once, {}% several times.",
                percent(once, all),
                percent(often, all),
            )
        },
    },
    switching: Plot {
        title: "Another way the next time?",
        axes: ["share of these visits [%]", ""],
        caption: |switching: &Switching| {
            format!(
                "Visits by the route of their first win, parted by the route of their next one. In {}, the next win went \
                 another way than the first. Without a suggestion from the game since the first win: {}.",
                plural(switching.switched, "visit"),
                grouped(switching.switched_undared),
            )
        },
    },
    after: |first, visits| format!("first win: {} ({})", route(first), plural(visits, "visit")),
    no_more: "no further win",
    dares: Plot {
        title: "Was the dare taken up?",
        axes: ["share of rounds with a dare [%]", ""],
        caption: |dares: &Dares| {
            format!(
                "Rounds before which the game suggested the other way. It did so in {}, and {} of these won as was suggested.",
                plural(dares.visits, "visit"),
                grouped(dares.visits_as_dared),
            )
        },
    },
    dare_parts: ["won as dared", "won another way", "not won"],
    pieces: Plot {
        title: "Pieces at the end",
        axes: ["pieces at the end of a round, up to", "rounds"],
        caption: |figures| {
            let [halves, dust] = halves_and_dust(figures);
            format!(
                "Rounds by how many pieces there were when they ended. {} ended in exactly two pieces, {} in more than 128: dust.",
                plural(halves, "round"),
                grouped(dust),
            )
        },
    },
    hands: Plot {
        title: "Where hands moved",
        axes: ["across the room [m]", "height [m]"],
        caption: |rounds, most, wide| {
            format!(
                "The darker, the longer hands were there: up to {most:.2} s of a round in a cell of {wide:.0} cm, and not at all \
                 where it is white. Thin line: the body as it begins; thick line: the basket; brown: what stands in the way. Of \
                 {} that were run again.",
                plural(rounds, "round"),
            )
        },
    },
    from_above: ["depth, front below [m]", "Seen from above."],
    no_hands: "Where hands moved is not shown: for that, rounds have to be run again. Make this report with --rerun; it also \
        checks that every round comes out as it was written.",
    best: Plot {
        title: "The best",
        axes: ["", ""],
        caption: "The fastest win by each route, on each day. Films are of the last day.",
    },
    best_columns: ["day", "route", "level", "time", "stand"],
    no_clip: "Without a film:",
    tables: [
        "By stand",
        "By day",
        "Languages shown",
        "What happened to the stands",
    ],
    columns: ["visits", "rounds", "visits that won", "median to first win"],
    more: |count| format!("and {count} more, in report.json"),
    language: |code| match code {
        "en" => Some("English"),
        "ja" => Some("Japanese"),
        "de" => Some("German"),
        "fr" => Some("French"),
        "zh" => Some("Chinese"),
        "ko" => Some("Korean"),
        "es" => Some("Spanish"),
        "" => Some("not known"),
        _ => None,
    },
    event: |kind| match kind {
        "began" => Some("the program was started"),
        "ended" => Some("the program ended as it was told to"),
        "crashed" => Some("the program broke down"),
        "hung" => Some("the program stood still and was started anew"),
        "lost_graphics" => Some("the GPU or the window was lost"),
        "gave_up" => Some("the program was not started anew any more"),
        "full_disk" => Some("the disk was full"),
        "damaged_file" => Some("a file was damaged and set aside"),
        "clock_changed" => Some("the clock was set"),
        "device_lost" => Some("a stick or pad was unplugged"),
        "device_found" => Some("a stick or pad was plugged in"),
        "staff_in" => Some("the staff's screen was opened"),
        "staff_refused" => Some("somebody was refused at the staff's screen"),
        "settings_changed" => Some("settings were changed"),
        _ => None,
    },
    basis: ("What this rests on", basis),
    refused: |count| {
        format!(
            "{} not counted anywhere:",
            if count == 1 {
                "One round is".into()
            } else {
                format!("{count} rounds are")
            }
        )
    },
    reason: |reason| match reason {
        Reason::Contradictory => "contradicts itself",
        Reason::Unreadable => "cannot be read",
        Reason::Astray => "goes another way when run again",
        Reason::Differs => "ends another way than was written",
    },
    foot: "Made by tamaire from its logbooks. They hold nothing about who anybody was.",
};

fn route(route: Route) -> &'static str {
    match route {
        Route::Squeeze => "squeezed in",
        Route::Shave => "shaved",
        Route::Mix => "some of both",
    }
}

fn time(seconds: f64) -> String {
    match seconds {
        s if s < 9.95 => format!("{s:.1} s"),
        s if s < 119.5 => format!("{s:.0} s"),
        s => format!(
            "{} min {:02} s",
            s.round() as u64 / 60,
            s.round() as u64 % 60
        ),
    }
}

fn plural(count: u64, noun: &str) -> String {
    let s = if count == 1 { "" } else { "s" };
    format!("{} {noun}{s}", grouped(count))
}

fn strategies(strategies: Strategies, figures: &Figures) -> String {
    let wins = figures.total.rounds;
    let [squeeze, shave, mix] =
        [wins.squeeze, wins.shave, wins.mix].map(|k| percent(k, wins.won()));
    let all = plural(wins.won(), "win");
    match strategies {
        Strategies::Few => format!(
            "Which strategies appear cannot be told yet: there are {all}, and it takes some twenty."
        ),
        Strategies::Both => format!(
            "Both strategies appeared here too. Of {all}, {squeeze}% were squeezed in whole and {shave}% shaved to fit; {mix}% \
             were some of both."
        ),
        Strategies::Only(Route::Squeeze) => format!(
            "Only one of the two strategies appeared: of {all}, {squeeze}% were squeezed in whole, and hardly any, {shave}%, shaved \
             to fit ({mix}% were some of both)."
        ),
        Strategies::Only(Route::Shave) => format!(
            "Only one of the two strategies appeared: of {all}, {shave}% were shaved to fit, and hardly any, {squeeze}%, squeezed \
             in whole ({mix}% were some of both)."
        ),
        Strategies::Only(Route::Mix) => format!(
            "The two strategies did not appear apart: of {all}, {mix}% were some of both, {squeeze}% squeezed in whole and {shave}% \
             shaved to fit."
        ),
    }
}

fn unexplained(unexplained: Unexplained, figures: &Figures) -> String {
    let total = &figures.total;
    let [share, low, high] = sure(total.visits_won, total.visits);
    let seen = format!(
        "{} of {} won, which is {share}% (95% interval {low} to {high}%)",
        grouped(total.visits_won),
        plural(total.visits, "visit"),
    );
    let soon = total
        .median_to_first_win
        .map(|median| format!(" Half of those who won had done so after {}.", time(median)));
    let soon = soon.unwrap_or_default();
    match unexplained {
        Unexplained::Few => format!("Whether an explanation is needed cannot be told yet: {seen}."),
        Unexplained::Most => format!("It seems that no explanation was needed: {seen}.{soon}"),
        Unexplained::Half => format!(
            "Whether an explanation was needed is open: {seen}, so whether more than half win is not known.{soon}"
        ),
        Unexplained::Minority => format!(
            "That no explanation was needed does not show here: {seen}. Most visits ended without a win.{soon}"
        ),
    }
}

fn reading_of_switching(is_known: bool, figures: &Figures) -> String {
    let (again, switching) = (won_again(figures), &figures.switching);
    let again_text = plural(again, "visit");
    if !is_known {
        return format!(
            "Whether people try the other way cannot be told yet: {again_text} won more than once."
        );
    }
    let switched = switching.switched;
    format!(
        "Of {again_text} that won more than once, {} ({}%) won the second time another way than the first. Without a suggestion \
         from the game in between: {}.",
        grouped(switched),
        percent(switched, again),
        grouped(switching.switched_undared),
    )
}

fn basis(basis: &Basis) -> Vec<String> {
    let mut said = vec![format!(
        "{}. A visit is what happens between two times at which a stand attracts; it is of the day on which it began, in the \
         local time of the stand, with all that was played in it.",
        plural(basis.files, "logbook"),
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
            "{} stood in more than one place and counted once.",
            plural(count, "row")
        ),
    );
    let count = basis.visits_without_end;
    say(
        count,
        format!(
            "{} without an end: cut off by power or a crash, or going on.",
            plural(count, "visit")
        ),
    );
    let count = basis.visits_with_clock_back;
    say(
        count,
        format!(
            "During {} the clock went backwards. Hours and days are by the clock; all else goes by the order of rounds.",
            plural(count, "visit")
        ),
    );
    if basis.is_rerun {
        said.push(format!(
            "{} were run again and came out as they were written.",
            plural(basis.rerun, "round")
        ));
        if basis.not_rerun > 0 {
            said.push(format!(
                "{} could not be run again, having no replay, other rules or an unknown level, and are counted unchecked.",
                plural(basis.not_rerun, "round"),
            ));
        }
    } else {
        said.push(
            "Rounds were not run again: that they came out as they were written was not checked."
                .into(),
        );
    }
    said
}
