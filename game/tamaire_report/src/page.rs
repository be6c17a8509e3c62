//! The HTML page: numbers first, then the comparison with 2004, then plots and tables.

use crate::clips::Clips;
use crate::comparison_2004;
use crate::figures::{Figures, LevelFigures, Totals, Wins};
use crate::html::{brief, escaped, figure, legend, paragraph, section, table};
use crate::plot::{Columns, Fill, PATTERNS, grouped, map, shares};
use crate::room::Stroke;
use crate::words::Words;
use base64::Engine;
use base64::prelude::BASE64_STANDARD as BASE64;
use tamaire_play::{Level, Route};

/// Maximum number of levels in plots.
const LEVELS: usize = 12;
/// Maximum number of rows of a table, and of rounds in the list of uncounted rounds.
const ROWS: usize = 40;
/// Content security policy. Even if a text from a logbook gets past the escaping, the page loads nothing.
const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; img-src data:";

/// Returns the page. `strokes` has an entry for each of [`Figures::levels`]: the objects in the room of the
/// level, or an empty list if the level has no map.
pub fn page(words: &Words, figures: &Figures, strokes: &[Vec<Stroke>], clips: &Clips) -> String {
    let (code, title) = (words.code, escaped(words.title));
    let css = include_str!("page.css");
    let mut page = format!(
        "<!DOCTYPE html>\n<html lang=\"{code}\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"{POLICY}\">\n\
         <title>{title}</title>\n<style>\n{css}</style>\n</head>\n<body>\n{PATTERNS}",
    );
    page += &header(words, figures);
    page += &numbers(words, figures);
    if figures.total.visits == 0 {
        page += &section(words.title, &paragraph(words.nothing));
    } else {
        page += &read(words, figures);
        page += &plots(words, figures);
        page += &hands(words, figures, strokes);
        page += &best(words, figures, clips);
        page += &totals(words, figures);
    }
    page += &others(words, figures);
    page += &basis(words, figures);
    page + &format!(
        "<footer>{}</footer>\n</body>\n</html>\n",
        escaped(words.foot)
    )
}

fn header(words: &Words, figures: &Figures) -> String {
    let stands = figures.stands.iter().take(5);
    let mut names: Vec<String> = stands.map(|stand| brief(&stand.stand, 40)).collect();
    names.retain(|name| !name.trim().is_empty());
    let days = Some((words.days)(figures)).filter(|days| !days.is_empty());
    let said: Vec<String> = days.into_iter().chain(names).collect();
    let (title, said) = (escaped(words.title), escaped(&said.join(" · ")));
    format!("<header><h1>{title}</h1><p>{said}</p></header>\n")
}

fn numbers(words: &Words, figures: &Figures) -> String {
    let total = &figures.total;
    let none = || words.none.to_string();
    let share = total
        .share_won
        .map(|share| format!("{:.0}%", 100.0 * share));
    let median = total.median_to_first_win.map(words.time);
    let of = |some: u64, all: u64| match total.visits {
        0 => String::new(),
        _ => (words.of)(some, all),
    };
    let cards = [
        ("", grouped(total.visits), String::new()),
        ("", grouped(total.rounds.all), String::new()),
        (
            " class=\"won\"",
            share.unwrap_or_else(none),
            of(total.visits_won, total.visits),
        ),
        ("", median.unwrap_or_else(none), String::new()),
    ];
    let card = |((class, number, below), name): ((&str, String, String), &str)| {
        let [number, name, below] = [&number, name, &below].map(escaped);
        format!("<div{class}><b>{number}</b>{name}<small>{below}</small></div>\n")
    };
    let cards: String = cards.into_iter().zip(words.numbers).map(card).collect();
    format!("<div class=\"numbers\">{cards}</div>\n")
}

fn read(words: &Words, figures: &Figures) -> String {
    let said = &words.reading;
    let switching = comparison_2004::tells_switching(figures);
    let here = [
        (said.strategies)(comparison_2004::strategies(figures), figures),
        (said.unexplained)(comparison_2004::unexplained(figures), figures),
        (said.switching)(switching, figures),
    ];
    let gap = if words.code == "ja" { "" } else { " " };
    let paragraphs = [said.then, &here.join(gap), said.unknown];
    section(said.title, &paragraphs.map(paragraph).concat())
}

fn plots(words: &Words, figures: &Figures) -> String {
    let parts = named(words.parts);
    let all = [
        hours(words, figures),
        first_win(words, figures),
        by_level(words, figures, &parts),
        by_try(words, figures, &parts),
        switching(words, figures),
        dares(words, figures),
        per_visit(words, figures),
        pieces(words, figures, &parts),
    ];
    format!("<div class=\"plots\">\n{}</div>\n", all.concat())
}

fn hours(words: &Words, figures: &Figures) -> String {
    let of = |count: fn(&crate::figures::Hour) -> u64| figures.hours.iter().map(count).collect();
    let label = |hour: usize| match hour % 3 {
        0 => hour.to_string(),
        _ => String::new(),
    };
    let columns = Columns {
        labels: (0..24).map(label).collect(),
        is_edge: true,
        series: vec![
            (Fill::Squeeze, of(|hour| hour.visits)),
            (Fill::Pale, of(|hour| hour.rounds)),
        ],
        is_stacked: false,
        axes: words.hours.axes,
        mark: None,
    };
    let [visits, rounds] = words.hour_series;
    let legend = legend(&[(Fill::Squeeze, visits), (Fill::Pale, rounds)]);
    let caption = (words.hours.caption)(figures);
    figure(words.hours.title, &legend, &columns.svg(), &caption)
}

fn first_win(words: &Words, figures: &Figures) -> String {
    let times = &figures.to_first_win;
    let (Some(quantiles), Some(first)) = (times.quantiles, times.bins.first()) else {
        return String::new();
    };
    let wide = first.to.unwrap_or(1.0);
    // If there are more than nine bins, only every second bin has a label.
    let label = |(k, from): (usize, f64)| match k % 2 {
        1 if times.bins.len() > 9 => String::new(),
        _ => format!("{from}"),
    };
    let from = times.bins.iter().map(|bin| bin.from).enumerate();
    let columns = Columns {
        labels: from.map(label).collect(),
        is_edge: true,
        series: vec![(
            Fill::Squeeze,
            times.bins.iter().map(|bin| bin.visits).collect(),
        )],
        is_stacked: false,
        axes: words.first_win.axes,
        mark: Some((quantiles[2] / wide, (words.median)(quantiles[2]))),
    };
    let caption = (words.first_win.caption)(figures);
    figure(words.first_win.title, "", &columns.svg(), &caption)
}

fn by_level(words: &Words, figures: &Figures, legend: &str) -> String {
    let row = |level: &LevelFigures| {
        let count = (words.level_rounds)(level.rounds.all, level.tries_per_win);
        (
            format!("{} ({count})", title_of(words, level)),
            level.rounds.parts(),
        )
    };
    let rows: Vec<_> = figures.levels.iter().take(LEVELS).map(row).collect();
    shares_if_any(&words.by_level, legend, &rows, words.by_level.caption)
}

fn by_try(words: &Words, figures: &Figures, legend: &str) -> String {
    let tries = words.tries.iter().zip(&figures.tries);
    let rows: Vec<_> = tries
        .map(|(name, rounds)| row(words, name, *rounds))
        .collect();
    shares_if_any(&words.by_try, legend, &rows, words.by_try.caption)
}

fn switching(words: &Words, figures: &Figures) -> String {
    let routes = [Route::Squeeze, Route::Shave, Route::Mix];
    let after = routes.into_iter().zip(&figures.switching.after);
    let row = |(route, next): (Route, &Wins)| ((words.after)(route, next.all), next.parts());
    let rows: Vec<_> = after.map(row).collect();
    let [squeeze, shave, mix, _] = words.parts;
    let legend = named([squeeze, shave, mix, words.no_more]);
    let caption = (words.switching.caption)(&figures.switching);
    shares_if_any(&words.switching, &legend, &rows, &caption)
}

fn dares(words: &Words, figures: &Figures) -> String {
    let dares = &figures.dares;
    let lost = dares.rounds - dares.won_as_dared - dares.won_otherwise;
    let parts = [dares.won_as_dared, 0, dares.won_otherwise, lost];
    let [dared, otherwise, not_won] = words.dare_parts;
    let names = [
        (Fill::Squeeze, dared),
        (Fill::Mix, otherwise),
        (Fill::Pale, not_won),
    ];
    let rows = [((words.rounds)(dares.rounds), parts)];
    let caption = (words.dares.caption)(dares);
    shares_if_any(&words.dares, &legend(&names), &rows, &caption)
}

fn per_visit(words: &Words, figures: &Figures) -> String {
    // The columns go up to the largest number of rounds in a visit, but at least to five.
    let last = figures
        .rounds_per_visit
        .iter()
        .rposition(|visits| *visits > 0);
    let last = last
        .unwrap_or(0)
        .clamp(5, figures.rounds_per_visit.len() - 1);
    let is_all = last + 1 == figures.rounds_per_visit.len();
    let label = |k: usize| match k {
        k if k == last && is_all => format!("{k}+"),
        k if k % 2 == 1 && last > 10 => String::new(),
        k => k.to_string(),
    };
    let columns = Columns {
        labels: (0..=last).map(label).collect(),
        is_edge: false,
        series: vec![(Fill::Squeeze, figures.rounds_per_visit[..=last].to_vec())],
        is_stacked: false,
        axes: words.per_visit.axes,
        mark: None,
    };
    let caption = (words.per_visit.caption)(figures);
    figure(words.per_visit.title, "", &columns.svg(), &caption)
}

fn pieces(words: &Words, figures: &Figures, legend: &str) -> String {
    let bins = figures.pieces.iter();
    let label = |bin: &crate::figures::Pieces| match bin.to {
        Some(to) => to.to_string(),
        None => format!(">{}", bin.from - 1),
    };
    let part = |k: usize| bins.clone().map(|bin| bin.rounds.parts()[k]).collect();
    let fills = Fill::ALL.into_iter().enumerate();
    let columns = Columns {
        labels: bins.clone().map(label).collect(),
        is_edge: false,
        series: fills.map(|(k, fill)| (fill, part(k))).collect(),
        is_stacked: true,
        axes: words.pieces.axes,
        mark: None,
    };
    let caption = (words.pieces.caption)(figures);
    figure(words.pieces.title, legend, &columns.svg(), &caption)
}

fn hands(words: &Words, figures: &Figures, strokes: &[Vec<Stroke>]) -> String {
    if !figures.basis.is_rerun {
        return section(words.hands.title, &paragraph(words.no_hands));
    }
    let levels = figures.levels.iter().zip(strokes).take(LEVELS);
    let maps = levels.filter_map(|(level, strokes)| {
        let heat = level.hands.as_ref()?;
        let is_from_above = heat.axes[1] != 1;
        let mut axes = words.hands.axes;
        let most = heat.seconds.iter().copied().fold(0.0, f64::max) / heat.rounds.max(1) as f64;
        let wide = 100.0 * f64::from(heat.cell);
        let mut caption = (words.hands.caption)(heat.rounds, most, wide);
        if is_from_above {
            axes[1] = words.from_above[0];
            caption = format!("{caption} {}", words.from_above[1]);
        }
        let title = format!("{}: {}", words.hands.title, title_of(words, level));
        Some(figure(&title, "", &map(heat, strokes, axes), &caption))
    });
    format!(
        "<div class=\"plots\">\n{}</div>\n",
        maps.collect::<String>()
    )
}

fn best(words: &Words, figures: &Figures, clips: &Clips) -> String {
    if figures.best.is_empty() {
        return String::new();
    }
    let mut inside = paragraph(words.best.caption);
    let shown = clips.films.iter().map(|(best, gif)| {
        let best = &figures.best[*best];
        let said = [
            (words.route)(best.route).to_string(),
            level_title(words, &best.level, &best.level_hash),
            (words.time)(best.seconds),
        ];
        let said = escaped(&said.join(" · "));
        let data = BASE64.encode(gif);
        format!("<div><img src=\"data:image/gif;base64,{data}\" alt=\"{said}\">{said}</div>\n")
    });
    let shown: String = shown.collect();
    if !shown.is_empty() {
        inside += &format!("<div class=\"clips\">{shown}</div>\n");
    }
    for why in &clips.missing {
        inside += &paragraph(&format!("{} {}", words.no_clip, brief(why, 300)));
    }
    let rows = figures.best.iter().rev().take(ROWS).map(|best| {
        [
            best.day.to_string(),
            (words.route)(best.route).into(),
            level_title(words, &best.level, &best.level_hash),
            (words.time)(best.seconds),
            best.stand.clone(),
        ]
    });
    inside += &table(words.best_columns, 5, &rows.collect::<Vec<_>>());
    inside += &more(words, figures.best.len());
    section(words.best.title, &inside)
}

fn totals(words: &Words, figures: &Figures) -> String {
    let cells = |name: String, totals: &Totals| {
        let share = totals
            .share_won
            .map(|share| format!("{:.0}%", 100.0 * share));
        let median = totals.median_to_first_win.map(words.time);
        let [share, median] = [share, median].map(|cell| cell.unwrap_or_else(|| words.none.into()));
        [
            name,
            grouped(totals.visits),
            grouped(totals.rounds.all),
            share,
            median,
        ]
    };
    let [visits, rounds, share, median] = words.columns;
    let head = ["", visits, rounds, share, median];
    let stands = figures.stands.iter().take(ROWS);
    let stands: Vec<_> = stands
        .map(|of| cells(of.stand.clone(), &of.totals))
        .collect();
    let days = figures.days.iter().rev().take(ROWS);
    let days: Vec<_> = days
        .map(|of| cells(of.day.to_string(), &of.totals))
        .collect();
    let all = [
        (0, stands, figures.stands.len()),
        (1, days, figures.days.len()),
    ];
    let tables = all.into_iter().filter(|(_, _, count)| *count > 1);
    let tables = tables.map(|(k, rows, count)| {
        section(
            words.tables[k],
            &(table(head, 1, &rows) + &more(words, count)),
        )
    });
    tables.collect()
}

fn others(words: &Words, figures: &Figures) -> String {
    let languages = figures.languages.iter().map(|language| {
        let name = (words.language)(&language.name).unwrap_or(&language.name);
        [name.to_string(), grouped(language.count)]
    });
    let events = figures.events.iter().map(|event| {
        let name = (words.event)(&event.name).unwrap_or(&event.name);
        [name.to_string(), grouped(event.count)]
    });
    let all: [(usize, Vec<[String; 2]>); 2] = [(2, languages.collect()), (3, events.collect())];
    let tables = all.into_iter().filter(|(_, rows)| !rows.is_empty());
    let tables = tables.map(|(k, rows)| {
        let shown = &rows[..rows.len().min(ROWS)];
        let table = table(["", words.hours.axes[1]], 1, shown);
        section(words.tables[k], &(table + &more(words, rows.len())))
    });
    format!(
        "<div class=\"plots\">\n{}</div>\n",
        tables.collect::<String>()
    )
}

fn basis(words: &Words, figures: &Figures) -> String {
    let (title, said) = words.basis;
    let mut inside: String = said(&figures.basis)
        .iter()
        .map(|text| paragraph(text))
        .collect();
    let refused = &figures.basis.refused;
    if !refused.is_empty() {
        inside += &paragraph(&(words.refused)(refused.len()));
        inside += "<ul>";
        for round in refused.iter().take(ROWS) {
            let why = format!(
                "{}: {}",
                (words.reason)(round.reason),
                brief(&round.detail, 200)
            );
            inside += &format!("<li><code>{}</code> {}</li>\n", round.round, escaped(&why));
        }
        inside += "</ul>";
        inside += &more(words, refused.len());
    }
    section(title, &inside)
}

fn row(words: &Words, name: &str, rounds: Wins) -> (String, [u64; 4]) {
    let count = (words.rounds)(rounds.all);
    (format!("{name} ({count})"), rounds.parts())
}

fn shares_if_any<C>(
    plot: &crate::words::Plot<C>,
    legend: &str,
    rows: &[(String, [u64; 4])],
    caption: &str,
) -> String {
    let rows: Vec<_> = rows
        .iter()
        .filter(|(_, parts)| parts.iter().any(|part| *part > 0))
        .cloned()
        .collect();
    match rows.is_empty() {
        true => String::new(),
        false => figure(plot.title, legend, &shares(&rows, plot.axes[0]), caption),
    }
}

fn named(names: [&str; 4]) -> String {
    let entries = Fill::ALL.into_iter().zip(names);
    legend(&entries.collect::<Vec<_>>())
}

fn more(words: &Words, count: usize) -> String {
    match count.checked_sub(ROWS) {
        Some(rest) if rest > 0 => paragraph(&(words.more)(rest)),
        _ => String::new(),
    }
}

fn title_of(words: &Words, level: &LevelFigures) -> String {
    level_title(words, &level.level, &level.level_hash)
}

/// Returns the title of a built-in level, or the name of any other level. The last four digits of the hash
/// follow if the level is not exactly the built-in version.
fn level_title(words: &Words, name: &str, hash: &str) -> String {
    let digits = &hash[hash.len().saturating_sub(4)..];
    let Ok(level) = Level::open(name) else {
        return format!("{} {digits}", brief(name, 24));
    };
    let titles = &level.game().name;
    let title = match words.code {
        "ja" => titles.ja.as_ref().unwrap_or(&titles.en),
        _ => &titles.en,
    };
    match format!("{:016x}", level.hash()) == hash {
        true => title.clone(),
        false => format!("{title} {digits}"),
    }
}
