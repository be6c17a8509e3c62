//! What a page is put together from. Texts are escaped here, whoever wrote them.

use crate::plot::Fill;

/// A text from a logbook that is longer is cut short on a page [letters].
const LONG: usize = 80;

/// A text as it may stand between tags and in attributes.
pub fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => safe += "&amp;",
            '<' => safe += "&lt;",
            '>' => safe += "&gt;",
            '"' => safe += "&quot;",
            '\'' => safe += "&#39;",
            // What turns the direction of writing would turn the rest of the page.
            '\u{202A}'..='\u{202E}' | '\u{2066}'..='\u{2069}' => {}
            _ if letter.is_control() => safe.push(' '),
            _ => safe.push(letter),
        }
    }
    safe
}

/// The beginning of a text from a logbook.
pub fn brief(text: &str, most: usize) -> String {
    let mut letters = text.chars();
    let mut brief: String = letters.by_ref().take(most).collect();
    if letters.next().is_some() {
        brief.push('…');
    }
    brief
}

/// A plot with a title, a legend and a caption.
pub fn figure(title: &str, legend: &str, plot: &str, caption: &str) -> String {
    let title = escaped(title);
    let caption = escaped(caption);
    format!("<figure><h2>{title}</h2>{legend}{plot}<figcaption>{caption}</figcaption></figure>\n")
}

/// What fills stand for.
pub fn legend(entries: &[(Fill, &str)]) -> String {
    let entry = |(fill, name): &(Fill, &str)| {
        let (paint, edge, name) = (fill.paint(), fill.edge(), escaped(name));
        format!(
            "<li><svg viewBox=\"0 0 22 13\" aria-hidden=\"true\"><rect width=\"22\" height=\"13\" rx=\"2\" fill=\"{paint}\" stroke=\"{edge}\"/></svg>{name}</li>"
        )
    };
    let entries: String = entries.iter().map(entry).collect();
    format!("<ul class=\"legend\">{entries}</ul>")
}

/// A table, whose cells are numbers from a column on.
pub fn table<const N: usize>(head: [&str; N], numbers_from: usize, rows: &[[String; N]]) -> String {
    let line = |tag: &str, cells: &[String; N]| {
        let cells = cells.iter().enumerate().map(|(k, text)| {
            let class = if k >= numbers_from {
                " class=\"n\""
            } else {
                ""
            };
            format!("<{tag}{class}>{}</{tag}>", escaped(&brief(text, LONG)))
        });
        format!("<tr>{}</tr>\n", cells.collect::<String>())
    };
    let rows: String = rows.iter().map(|row| line("td", row)).collect();
    let head = line("th", &head.map(String::from));
    format!("<div class=\"scroll\"><table>{head}{rows}</table></div>")
}

/// A paragraph.
pub fn paragraph(text: &str) -> String {
    format!("<p>{}</p>\n", escaped(text))
}

/// A part of the page.
pub fn section(title: &str, inside: &str) -> String {
    format!("<section><h2>{}</h2>\n{inside}</section>\n", escaped(title))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_stays_a_text() {
        let hostile = "<script>alert(\"&'\")</script>\u{202E}\u{0}";
        let safe = "&lt;script&gt;alert(&quot;&amp;&#39;&quot;)&lt;/script&gt; ";
        assert_eq!(escaped(hostile), safe);
        let row = table(["a"], 1, &[["<b>".repeat(100)]]);
        assert!(row.contains("…") && !row.contains("<b>"));
    }
}
