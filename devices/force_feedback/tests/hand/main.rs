//! Forces felt by a hand that holds a stick.

mod body;
mod closed_loop;
mod real_body;
mod stick;
