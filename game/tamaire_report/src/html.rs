//! HTML elements of the page. All texts are escaped here.

use crate::plot::Fill;

/// Maximum length of a text in a table cell [characters].
const LONG: usize = 80;

/// Escapes a text for element content and attributes.
pub fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => safe += "&amp;",
            '<' => safe += "&lt;",
            '>' => safe += "&gt;",
            '"' => safe += "&quot;",
            '\'' => safe += "&#39;",
            // Bidirectional control characters are removed: they would affect the text that follows on the
            // page.
            '\u{202A}'..='\u{202E}' | '\u{2066}'..='\u{2069}' => {}
            _ if letter.is_control() => safe.push(' '),
            _ => safe.push(letter),
        }
    }
    safe
}

/// Truncates a text to `most` characters.
pub fn brief(text: &str, most: usize) -> String {
    let mut letters = text.chars();
    let mut brief: String = letters.by_ref().take(most).collect();
    if letters.next().is_some() {
        brief.push('…');
    }
    brief
}

/// Returns a plot with a title, a legend and a caption.
pub fn figure(title: &str, legend: &str, plot: &str, caption: &str) -> String {
    let title = escaped(title);
    let caption = escaped(caption);
    format!("<figure><h2>{title}</h2>{legend}{plot}<figcaption>{caption}</figcaption></figure>\n")
}

/// Returns a legend of fills and their names.
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

/// Returns a table. Cells from column `numbers_from` on are aligned as numbers.
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

/// Returns a paragraph.
pub fn paragraph(text: &str) -> String {
    format!("<p>{}</p>\n", escaped(text))
}

/// Returns a section with a title.
pub fn section(title: &str, inside: &str) -> String {
    format!("<section><h2>{}</h2>\n{inside}</section>\n", escaped(title))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_escaped_and_truncated() {
        let hostile = "<script>alert(\"&'\")</script>\u{202E}\u{0}";
        let safe = "&lt;script&gt;alert(&quot;&amp;&#39;&quot;)&lt;/script&gt; ";
        assert_eq!(escaped(hostile), safe);
        let row = table(["a"], 1, &[["<b>".repeat(100)]]);
        assert!(row.contains("…") && !row.contains("<b>"));
    }
}
