//! Tests of the public interface. They are one program, because each further one adds seconds of compilation.

mod assists;
mod bots;
mod levels;
mod links;
mod models;
mod pictures;
mod rewind;
mod ways;
