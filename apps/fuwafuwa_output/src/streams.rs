//! Standard output and standard error.

use clap::Parser;
use std::fmt::Display;
use std::io::{self, ErrorKind, Write};

/// Exit status for output that cannot be written.
const NOT_WRITTEN: i32 = 2;

/// Prints a text to standard output and flushes it.
///
/// A closed pipe is no error: the reader, for example `head` or a pager, has read enough.
///
/// # Errors
/// The error of the system, for example of a full disk.
pub fn print(text: &str) -> io::Result<()> {
    print_to(&mut io::stdout().lock(), text)
}

fn print_to(out: &mut impl Write, text: &str) -> io::Result<()> {
    checked(out.write_all(text.as_bytes()).and_then(|()| out.flush()))
}

/// Turns the error of a closed pipe into success, and adds the name of the stream to other errors.
fn checked(written: io::Result<()>) -> io::Result<()> {
    match written {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        Err(error) => Err(io::Error::new(
            error.kind(),
            format!("standard output: {error}"),
        )),
        Ok(()) => Ok(()),
    }
}

/// Prints a line to standard error. A failure is ignored, because no place is left to report it.
pub fn warn(line: impl Display) {
    let _ = writeln!(io::stderr(), "{line}");
}

/// Parses the command line of the process. Prints the requested help or version, or the mistake in the
/// command line, and ends the process. A closed pipe is no error, as for [`print`](print()).
///
/// The exit status is 0 for help and version, and 2 for a mistake or if the output cannot be written.
pub fn parse<P: Parser>() -> P {
    P::try_parse().unwrap_or_else(|error| {
        if error.use_stderr() {
            error.exit();
        }
        // Colours follow clap's rules, for example `NO_COLOR`.
        let printed = error.print().and_then(|()| io::stdout().flush());
        std::process::exit(match checked(printed) {
            Ok(()) => 0,
            Err(error) => {
                warn(format_args!("{}: {error}", P::command().get_name()));
                NOT_WRITTEN
            }
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Output that fails with a kind of error when it is flushed, as a buffered output does.
    struct Failing(ErrorKind);

    impl Write for Failing {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            Ok(bytes.len())
        }

        fn flush(&mut self) -> io::Result<()> {
            Err(self.0.into())
        }
    }

    #[test]
    fn print_ignores_a_closed_pipe_only() {
        assert!(print_to(&mut Failing(ErrorKind::BrokenPipe), "text").is_ok());
        let error = print_to(&mut Failing(ErrorKind::StorageFull), "text").unwrap_err();
        assert_eq!(error.kind(), ErrorKind::StorageFull);
        assert!(error.to_string().starts_with("standard output: "));
    }
}
