//! CSV tables for spreadsheets and programs [RFC 4180].

use std::fmt::Display;

/// Byte order mark at the start of a table. Without it, Excel reads UTF-8 as the encoding of its country.
pub const MARK: &str = "\u{feff}";

/// Row of a table as text.
#[derive(Debug, Default)]
pub struct CsvRow {
    text: String,
    is_begun: bool,
}

impl CsvRow {
    /// Returns the header row with the names of the columns.
    pub fn names(names: &[&str]) -> Self {
        let row = names
            .iter()
            .fold(Self::default(), |row, name| row.text(name));
        row.end()
    }

    /// Appends a cell with an untrusted text. If a spreadsheet would take the text for a formula, an
    /// apostrophe is put before it.
    pub fn text(mut self, text: &str) -> Self {
        let formula = ['=', '+', '-', '@', '\t', '\r', '\n'];
        // Full-width signs are guarded, too, because some programs treat them like ASCII signs.
        let wide = ['＝', '＋', '－', '＠'];
        let is_formula = text.starts_with(formula) || text.starts_with(wide);
        let guard = if is_formula { "'" } else { "" };
        self.separate();
        if text.contains(['"', ',', '\r', '\n']) {
            self.text += &format!("\"{guard}{}\"", text.replace('"', "\"\""));
        } else {
            self.text += guard;
            self.text += text;
        }
        self
    }

    /// Appends a cell with a number or a trusted word.
    pub fn value(mut self, value: impl Display) -> Self {
        use std::fmt::Write;
        self.separate();
        write!(self.text, "{value}").expect("writing to a string cannot fail");
        self
    }

    /// Appends a cell with a value, or an empty cell for `None`.
    pub fn maybe(self, value: Option<impl Display>) -> Self {
        match value {
            Some(value) => self.value(value),
            None => self.text(""),
        }
    }

    /// Ends the row.
    pub fn end(mut self) -> Self {
        self.text += "\r\n";
        self
    }

    /// Returns the bytes of the row.
    pub fn bytes(&self) -> &[u8] {
        self.text.as_bytes()
    }

    fn separate(&mut self) {
        if std::mem::replace(&mut self.is_begun, true) {
            self.text.push(',');
        }
    }
}

#[cfg(test)]
mod tests {
    use super::CsvRow;

    #[test]
    fn cells_are_quoted_and_formulas_are_escaped() {
        let row = CsvRow::default()
            .text("")
            .text("a,b")
            .text("say \"hi\"\r\nnow")
            .value(-1.5);
        let row = row
            .text("=1+1")
            .text("+x")
            .text("-x")
            .text("@x")
            .text("\t=1")
            .text("a=1");
        let row = row.maybe(None::<u8>).maybe(Some(2)).text("=\"a\",b").end();
        let expected = ",\"a,b\",\"say \"\"hi\"\"\r\nnow\",-1.5,'=1+1,'+x,'-x,'@x,'\t=1,a=1,,2,\"'=\"\"a\"\",b\"\r\n";
        assert_eq!(row.text, expected);
    }
}
