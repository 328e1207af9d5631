//! Values drawn from a fuzzer's bytes.

use arbitrary::Unstructured;

/// Values that are at the end of something.
const SPECIAL: [f32; 28] = [
    0.0,
    -0.0,
    f32::INFINITY,
    f32::NEG_INFINITY,
    f32::NAN,
    f32::MAX,
    f32::MIN,
    f32::MIN_POSITIVE,
    -f32::MIN_POSITIVE,
    1e-45,
    -1e-45,
    1e-38,
    1e38,
    -1e38,
    1e-30,
    1e30,
    1e-18,
    1e18,
    -1e18,
    1e-9,
    1e9,
    -1e9,
    1e-6,
    1e6,
    f32::EPSILON,
    1.000_000_1,
    std::f32::consts::FRAC_PI_2,
    std::f32::consts::PI,
];

/// Values as scenes have them.
const TAME: [f32; 16] = [
    1.0, 0.5, 2.0, 0.0, -1.0, 0.1, 10.0, 3.7, -0.3, -5.0, 0.01, 100.0, 0.25, -2.5, 7.0, 0.9,
];

/// Draws values from bytes: how many are wild is drawn first, for an input of wild values alone never gets past the first check.
pub(crate) struct Draw<'a> {
    bytes: Unstructured<'a>,
    wild: u8,
}

impl<'a> Draw<'a> {
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        let mut draw = Self {
            bytes: Unstructured::new(bytes),
            wild: 0,
        };
        draw.wild = *draw.one_of(&[0, 3, 12, 60]);
        draw
    }

    /// A byte; 0 when they are used up.
    pub(crate) fn byte(&mut self) -> u8 {
        self.bytes.arbitrary().unwrap_or_default()
    }

    /// True once in `n`, and never when the bytes are used up.
    pub(crate) fn once_in(&mut self, n: u8) -> bool {
        self.byte() % n == n - 1
    }

    /// A whole number below `n`.
    pub(crate) fn below(&mut self, n: u8) -> u8 {
        self.byte() % n
    }

    pub(crate) fn one_of<'b, T>(&mut self, list: &'b [T]) -> &'b T {
        &list[usize::from(self.byte()) % list.len()]
    }

    fn is_wild(&mut self) -> bool {
        self.byte() >= u8::MAX - self.wild
    }

    /// A number, any at all where it is wild.
    pub(crate) fn real(&mut self) -> f32 {
        self.real_or(|draw| *draw.one_of(&TAME))
    }

    /// A number that is `tame` or wild.
    pub(crate) fn real_or(&mut self, tame: impl FnOnce(&mut Self) -> f32) -> f32 {
        if !self.is_wild() {
            tame(self)
        } else if self.once_in(4) {
            f32::from_bits(self.bytes.arbitrary().unwrap_or_default())
        } else {
            *self.one_of(&SPECIAL)
        }
    }

    /// A number that is 0 or more unless it is wild.
    pub(crate) fn positive(&mut self) -> f32 {
        self.real_or(|draw| draw.one_of(&TAME).abs())
    }

    /// A number of 0 to 1 unless it is wild.
    pub(crate) fn unit(&mut self) -> f32 {
        self.real_or(|draw| f32::from(draw.byte()) / 255.0)
    }

    pub(crate) fn many<const N: usize>(&mut self, of: fn(&mut Self) -> f32) -> [f32; N] {
        std::array::from_fn(|_| of(self))
    }

    pub(crate) fn list<T>(&mut self, count: usize, of: impl Fn(&mut Self) -> T) -> Vec<T> {
        (0..count).map(|_| of(self)).collect()
    }
}
