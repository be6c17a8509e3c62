//! What a row is known by.

use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;
use std::str::FromStr;

/// By what a row is known, at every stand and on every server: 128 random bits. As text, 32 hexadecimal digits.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Id(pub u128);

/// Why a text is no [`Id`].
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("expected an id of 32 hexadecimal digits, found {0:?}")]
pub struct NoId(
    /// The text.
    pub String,
);

impl Id {
    /// A new one, which nobody else has.
    pub fn random() -> Self {
        let mut bytes = [0; 16];
        match getrandom::fill(&mut bytes) {
            Ok(()) => Self(u128::from_be_bytes(bytes)),
            // A machine without randomness of its own has at least a clock and addresses.
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
    type Err = NoId;

    fn from_str(text: &str) -> Result<Self, NoId> {
        let is_hex = text.len() == 32 && text.bytes().all(|byte| byte.is_ascii_hexdigit());
        let number = u128::from_str_radix(text, 16).ok().filter(|_| is_hex);
        number.map(Self).ok_or_else(|| NoId(text.into()))
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
    fn an_id_is_written_as_hexadecimal_digits_and_read_again() {
        let id = Id(0xab);
        assert_eq!(id.to_string(), "000000000000000000000000000000ab");
        assert_eq!(id.to_string().parse(), Ok(id));
        for wrong in [
            "",
            "ab",
            "+00000000000000000000000000000ab",
            "000000000000000000000000000000axx",
        ] {
            assert_eq!(wrong.parse::<Id>(), Err(NoId(wrong.into())));
        }
        assert_ne!(Id::random(), Id::random());
    }
}
