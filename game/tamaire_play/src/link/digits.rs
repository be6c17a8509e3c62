//! Encoding of bytes as decimal digits for QR codes. A QR code stores three digits in ten bits, but one
//! character of base64 in eight bits.

/// Number of decimal digits that encode 0 to 7 bytes. Bytes are encoded in groups of seven; the smaller
/// entries serve the last group.
const DIGITS: [usize; 8] = [0, 3, 5, 8, 10, 13, 15, 17];
const BYTES: usize = DIGITS.len() - 1;

/// Encodes bytes as digits.
pub(super) fn write(bytes: &[u8]) -> String {
    let chunks = bytes.chunks(BYTES).map(|chunk| {
        let number = chunk
            .iter()
            .fold(0u64, |all, &byte| all << 8 | u64::from(byte));
        format!("{number:0width$}", width = DIGITS[chunk.len()])
    });
    chunks.collect()
}

/// Decodes digits from [`write`]; `None` if they are invalid.
pub(super) fn read(digits: &str) -> Option<Vec<u8>> {
    let mut bytes = Vec::with_capacity(digits.len() / 2);
    for chunk in digits.as_bytes().chunks(DIGITS[BYTES]) {
        let count = DIGITS.iter().position(|&count| count == chunk.len())?;
        let is_digits = chunk.iter().all(u8::is_ascii_digit);
        let text = std::str::from_utf8(chunk).ok().filter(|_| is_digits)?;
        let number = text.parse::<u64>().ok()?.to_be_bytes();
        let (spare, meant) = number.split_at(number.len() - count);
        if spare.iter().any(|&byte| byte != 0) {
            return None;
        }
        bytes.extend(meant);
    }
    Some(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_round_trip_close_to_the_minimum_length() {
        let mut random = fastrand::Rng::with_seed(5);
        for length in (0..40).chain([1000]) {
            for byte in [None, Some(0), Some(255)] {
                let bytes: Vec<u8> = (0..length).map(|_| byte.unwrap_or(random.u8(..))).collect();
                let digits = write(&bytes);
                assert_eq!(read(&digits), Some(bytes));
                assert!(digits.len() <= 3 + (length as f32 * 2.43) as usize);
            }
        }
        for wrong in [
            "1",
            "256",
            "65536",
            "99999999999999999",
            "12a",
            "+12",
            "１２３",
        ] {
            assert_eq!(read(wrong), None, "{wrong}");
        }
    }
}
