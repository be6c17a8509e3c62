//! Tests of the public interface. They are one program, because each further one adds seconds of compilation.

mod assists;
mod bots;
mod daily;
mod levels;
mod links;
mod models;
mod pictures;
mod playground;
mod rewind;
mod ways;
