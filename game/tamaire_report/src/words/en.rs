//! English.

use super::{Plot, Reading, Words, busiest, halves_and_dust, once_and_often, percent, sure};
use crate::comparison_2004::{Strategies, Unexplained, won_again};
use crate::figures::{Basis, Dares, Figures, Reason, Switching};
use crate::plot::grouped;
use tamaire_play::Route;

/// Texts of the page in English.
pub static ENGLISH: Words = Words {
    code: "en",
    title: "Visitor report",
    days: |figures| match (figures.first_day, figures.last_day) {
        (Some(first), Some(last)) if first == last => first.to_string(),
        (Some(first), Some(last)) => format!(
            "{first} to {last}, {}",
            plural(figures.days.len() as u64, "day")
        ),
        _ => String::new(),
    },
    nothing: "There is no visit in these logbooks for the selected days, so there is nothing to show yet.",
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
        "a mix of both",
        "not won",
    ],
    route,
    tries: ["1st round", "2nd round", "3rd round", "4th round and later"],
    rounds: |count| plural(count, "round"),
    level_rounds: |count, tries| match tries {
        Some(tries) => format!("{}, {tries:.1} per win", plural(count, "round")),
        None => format!("{}, no win", plural(count, "round")),
    },
    reading: Reading {
        title: "Compared with 2004",
        then: "In 2004, visitors of a media festival were only told to put the body into the region between three bars. Two \
            strategies appeared: squeezing it in without breaking it, and shaving it down until it fit. Many people who had \
            won one way then tried the other.",
        strategies,
        unexplained,
        switching: reading_of_switching,
        unknown: "The logbooks do not record whether someone explained the game, or whether two visits were by the same \
            person. The game itself shows a pale hand at first, and may suggest the other way after a win.",
    },
    hours: Plot {
        title: "Visits by hour",
        axes: ["hour of the day, local time of the stand", "number"],
        caption: |figures| {
            let most = busiest(figures);
            let most = most.map(|(hours, visits)| match &hours[..] {
                [hour] => format!(
                    " The busiest hour had {}, beginning between {hour}:00 and {}:00.",
                    plural(visits, "visit"),
                    hour + 1
                ),
                hours => format!(
                    " The busiest hours began at {}, with {} each.",
                    listed(hours),
                    plural(visits, "visit")
                ),
            });
            format!(
                "Visits and rounds by the hour in which they began.{}",
                most.unwrap_or_default()
            )
        },
    },
    hour_series: ["visits", "rounds"],
    by_level: Plot {
        title: "Results by level",
        axes: ["share of the level's rounds [%]", ""],
        caption: "Each bar shows all rounds of a level, split by result. In brackets: all rounds, and how many \
            there were for each won round. The most played level comes first. Four digits after a \
            name mark an easier or another version of the level.",
    },
    by_try: Plot {
        title: "Results by attempt",
        axes: ["share of these rounds [%]", ""],
        caption: "The same results for the first, second, third and later rounds of a visit. As visitors learn, the share that \
            is not won shrinks from bar to bar.",
    },
    first_win: Plot {
        title: "Time to the first win",
        axes: ["playing time to the first win [s]", "visits"],
        caption: |figures| {
            let quantiles = figures.to_first_win.quantiles.unwrap_or_default();
            let rest = figures.total.visits - figures.to_first_win.visits;
            format!(
                "Visits by playing time to their first win; the last column holds all longer times. Half of the visits with a \
                 win needed at most {}, nine out of ten at most {}. {} without a win {} not shown.",
                time(quantiles[2]),
                time(quantiles[4]),
                plural(rest, "visit"),
                if rest == 1 { "is" } else { "are" },
            )
        },
    },
    median: |seconds| format!("median {}", time(seconds)),
    per_visit: Plot {
        title: "Rounds per visit",
        axes: ["rounds per visit", "visits"],
        caption: |figures| {
            let [once, often] = once_and_often(figures);
            let all = figures.total.visits;
            format!(
                "Visits by their number of rounds, won or not. {}% played once, {}% several times.",
                percent(once, all),
                percent(often, all),
            )
        },
    },
    switching: Plot {
        title: "Another way the second time?",
        axes: ["share of these visits [%]", ""],
        caption: |switching: &Switching| {
            format!(
                "Visits by the route of their first win, split by the route of their second. In {}, the second win took another \
                 route. Of these, visits without a suggestion from the game in between: {}.",
                plural(switching.switched, "visit"),
                grouped(switching.switched_undared),
            )
        },
    },
    after: |first, visits| format!("first win: {} ({})", route(first), plural(visits, "visit")),
    no_more: "no further win",
    dares: Plot {
        title: "Was the suggestion followed?",
        axes: ["share of rounds with a suggestion [%]", ""],
        caption: |dares: &Dares| {
            format!(
                "Rounds before which the game suggested the other way. It did so in {}, and {} of these won that way.",
                plural(dares.visits, "visit"),
                grouped(dares.visits_as_dared),
            )
        },
    },
    dare_parts: ["won as suggested", "won another way", "not won"],
    pieces: Plot {
        title: "Pieces at the end",
        axes: ["pieces at the end of a round, up to", "rounds"],
        caption: |figures| {
            let [halves, dust] = halves_and_dust(figures);
            format!(
                "Rounds by the number of pieces at their end. {} ended in exactly two pieces, {} in more than 128.",
                plural(halves, "round"),
                grouped(dust),
            )
        },
    },
    hands: Plot {
        title: "Where hands moved",
        axes: ["width [m]", "height [m]"],
        caption: |rounds, most, wide| {
            format!(
                "The darker a cell, the longer hands were there: up to {most:.2} s per round in a cell of {wide:.0} cm. White \
                 cells were never reached. Thin line: the body at the start; thick line: the basket; brown: obstacles. Based on \
                 {} that were run again.",
                plural(rounds, "round"),
            )
        },
    },
    from_above: ["depth, front at the bottom [m]", "Seen from above."],
    no_hands: "This map requires running the rounds again. Create the report with --rerun, which also checks that every round \
        gives its recorded result.",
    best: Plot {
        title: "Best rounds",
        axes: ["", ""],
        caption: "The fastest win by each route on each day. Clips are from the last day.",
    },
    best_columns: ["day", "route", "level", "time", "stand"],
    no_clip: "No clip of round",
    tables: [
        "By stand",
        "By day",
        "Languages shown",
        "Events at the stands",
    ],
    columns: [
        "visits",
        "rounds",
        "visits with a win",
        "median time to first win",
    ],
    more: |count| format!("and {count} more, in report.json"),
    language: |code| match code {
        "en" => Some("English"),
        "ja" => Some("Japanese"),
        "de" => Some("German"),
        "fr" => Some("French"),
        "zh" => Some("Chinese"),
        "ko" => Some("Korean"),
        "es" => Some("Spanish"),
        "" => Some("unknown"),
        _ => None,
    },
    event: |kind| match kind {
        "began" => Some("program started"),
        "ended" => Some("program ended normally"),
        "crashed" => Some("program crashed"),
        "hung" => Some("program hung and was restarted"),
        "lost_graphics" => Some("GPU or window lost"),
        "gave_up" => Some("out of order: no more restarts"),
        "full_disk" => Some("disk full"),
        "damaged_file" => Some("damaged file set aside"),
        "clock_changed" => Some("clock changed"),
        "device_lost" => Some("stick or gamepad unplugged"),
        "device_found" => Some("stick or gamepad plugged in"),
        "staff_in" => Some("staff screen opened"),
        "staff_refused" => Some("wrong PIN at the staff screen"),
        "settings_changed" => Some("settings changed"),
        _ => None,
    },
    basis: ("About these figures", basis),
    refused: |count| {
        format!(
            "{} not counted:",
            if count == 1 {
                "One round is".into()
            } else {
                format!("{count} rounds are")
            }
        )
    },
    reason: |reason| match reason {
        Reason::Contradictory => "contradictory record",
        Reason::Unreadable => "unreadable replay",
        Reason::Astray => "replay takes another course",
        Reason::Differs => "replay ends with another result",
    },
    foot: "Made by tamaire from its logbooks, which hold nothing that identifies a visitor.",
};

fn route(route: Route) -> &'static str {
    match route {
        Route::Squeeze => "squeezed in",
        Route::Shave => "shaved",
        Route::Mix => "a mix of both",
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

/// Lists hours: "9:00, 10:00 and 14:00".
fn listed(hours: &[usize]) -> String {
    let hours: Vec<String> = hours.iter().map(|hour| format!("{hour}:00")).collect();
    match hours.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, others)) => format!("{} and {last}", others.join(", ")),
        None => String::new(),
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
            "It is too early to tell which strategies appear: this takes about twenty wins, and the logbooks have {all}."
        ),
        Strategies::Both => format!(
            "Both strategies appeared here too. Of {all}, {squeeze}% were squeezed in whole and {shave}% shaved to fit; {mix}% \
             were a mix of both."
        ),
        Strategies::Only(Route::Squeeze) => format!(
            "Only one of the two strategies appeared: of {all}, {squeeze}% were squeezed in whole, and only {shave}% shaved to \
             fit ({mix}% were a mix of both)."
        ),
        Strategies::Only(Route::Shave) => format!(
            "Only one of the two strategies appeared: of {all}, {shave}% were shaved to fit, and only {squeeze}% squeezed in \
             whole ({mix}% were a mix of both)."
        ),
        Strategies::Only(Route::Mix) => format!(
            "The two strategies were mostly mixed: of {all}, {mix}% were a mix of both, {squeeze}% squeezed in whole and {shave}% \
             shaved to fit."
        ),
    }
}

fn unexplained(unexplained: Unexplained, figures: &Figures) -> String {
    let total = &figures.total;
    let [share, low, high] = sure(total.visits_won, total.visits);
    let seen = format!(
        "{} of {} won, which is {share}% (95% confidence interval {low} to {high}%)",
        grouped(total.visits_won),
        plural(total.visits, "visit"),
    );
    let soon = total
        .median_to_first_win
        .map(|median| format!(" The median time to the first win was {}.", time(median)));
    let soon = soon.unwrap_or_default();
    match unexplained {
        Unexplained::Few => format!("It is too early to say if an explanation is needed: {seen}."),
        Unexplained::Most => format!("Most visitors seem to need no explanation: {seen}.{soon}"),
        Unexplained::Half => format!(
            "Whether visitors need an explanation remains open: {seen}, so it is uncertain whether more than half win.{soon}"
        ),
        Unexplained::Minority => format!(
            "Some visitors may need an explanation: {seen}. Most visits ended without a win.{soon}"
        ),
    }
}

fn reading_of_switching(is_known: bool, figures: &Figures) -> String {
    let (again, switching) = (won_again(figures), &figures.switching);
    let again_text = plural(again, "visit");
    if !is_known {
        return format!(
            "It is too early to tell whether visitors try the other way: {again_text} won more than once."
        );
    }
    let switched = switching.switched;
    format!(
        "Of {again_text} that won more than once, {} ({}%) took another route the second time. Of these, visits without a \
         suggestion from the game in between: {}.",
        grouped(switched),
        percent(switched, again),
        grouped(switching.switched_undared),
    )
}

fn basis(basis: &Basis) -> Vec<String> {
    let mut said = vec![format!(
        "Based on {}. A visit lasts from the first touch until the stand is idle again. With all of its rounds, it counts for \
         the day on which it began, in the local time of the stand.",
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
            "{} occurred again and counted only once.",
            plural(count, "row")
        ),
    );
    let count = basis.visits_without_end;
    say(
        count,
        format!(
            "{} without an end: interrupted by a power cut or a crash, or still going on.",
            plural(count, "visit")
        ),
    );
    let count = basis.visits_with_clock_back;
    say(
        count,
        format!(
            "During {} the clock went backwards. Hours and days follow the clock; all other figures follow the order of rounds.",
            plural(count, "visit")
        ),
    );
    if basis.is_rerun {
        said.push(format!(
            "{} run again with the recorded result.",
            plural(basis.rerun, "round")
        ));
        if basis.not_rerun > 0 {
            said.push(format!(
                "{} counted unchecked, because of a missing replay, other rules or an unknown level.",
                plural(basis.not_rerun, "round"),
            ));
        }
    } else {
        said.push(
            "Rounds were not run again, so their recorded results were not checked for this report."
                .into(),
        );
    }
    said
}
