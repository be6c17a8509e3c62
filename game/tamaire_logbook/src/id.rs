//! Unique identifiers of rows.

use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;
use std::str::FromStr;

/// Identifier of a row, unique across all stands and servers: 128 random bits. Its text form has 32
/// hexadecimal digits.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Id(pub u128);

/// Error of parsing an [`Id`] from a text.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("expected an id of 32 hexadecimal digits, found {0:?}")]
pub struct ParseIdError(
    /// The text that was given.
    pub String,
);

impl Id {
    /// Returns a new random id.
    pub fn random() -> Self {
        let mut bytes = [0; 16];
        match getrandom::fill(&mut bytes) {
            Ok(()) => Self(u128::from_be_bytes(bytes)),
            // Without randomness from the operating system, fastrand is used, which is seeded from the time
            // and the thread.
            Err(_) => Self(fastrand::u128(..)),
        }
    }
}

impl fmt::Display for Id {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{:032x}", self.0)
    }
}

impl FromStr for Id {
    type Err = ParseIdError;

    fn from_str(text: &str) -> Result<Self, ParseIdError> {
        let is_hex = text.len() == 32 && text.bytes().all(|byte| byte.is_ascii_hexdigit());
        let number = u128::from_str_radix(text, 16).ok().filter(|_| is_hex);
        number.map(Self).ok_or_else(|| ParseIdError(text.into()))
    }
}

impl Serialize for Id {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for Id {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = String::deserialize(deserializer)?;
        text.parse().map_err(D::Error::custom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn id_round_trips_as_32_hexadecimal_digits() {
        let id = Id(0xab);
        assert_eq!(id.to_string(), "000000000000000000000000000000ab");
        assert_eq!(id.to_string().parse(), Ok(id));
        for wrong in [
            "",
            "ab",
            "+00000000000000000000000000000ab",
            "000000000000000000000000000000axx",
        ] {
            assert_eq!(wrong.parse::<Id>(), Err(ParseIdError(wrong.into())));
        }
        assert_ne!(Id::random(), Id::random());
    }
}
