//! The engine is compiled in its own crate, and not again in one that uses it, as this one does.

use fuwafuwa::compiled::compiled;
use fuwafuwa::{Dim2, Dim3, entries};

#[test]
fn who_uses_the_engine_calls_what_was_compiled_with_it() {
    let called = [entries!(Dim2), entries!(Dim3)];
    assert_eq!(
        called.each_ref().map(Vec::len),
        compiled().each_ref().map(Vec::len)
    );
    for (called, compiled) in called
        .into_iter()
        .flatten()
        .zip(compiled().into_iter().flatten())
    {
        assert_eq!(
            called.1, compiled.1,
            "{} is compiled again: is it #[inline(never)]?",
            called.0
        );
    }
}
