//! The engine is compiled once, in its own crate, and not again in a crate that uses it, such as this one.

use fuwafuwa::compiled::compiled;
use fuwafuwa::{Dim2, Dim3, entries};

#[test]
fn entry_points_are_compiled_only_in_engine_crate() {
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
            "{} was compiled again; it must be #[inline(never)]",
            called.0
        );
    }
}
