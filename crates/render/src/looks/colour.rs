//! Colours, and the default colours of roles.

/// A colour with red, green and blue components from 0 to 255.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Colour(pub [u8; 3]);

/// The colour of outlines and text.
pub(crate) const INK: Colour = Colour([0x22, 0x26, 0x30]);
/// The white of eyes, sparkles and paper.
pub(crate) const PAPER: Colour = Colour([0xff, 0xff, 0xff]);
/// The colour of the empty board.
pub(crate) const GROUND: Colour = Colour([0xf4, 0xf0, 0xe7]);
/// The colour of the lines between cells.
pub(crate) const GRID: Colour = Colour([0xe5, 0xde, 0xd0]);

/// The palette by Okabe and Ito ("Color Universal Design", 2008). Its colours can be told apart with any
/// common type of colour vision.
pub(crate) const ORANGE: Colour = Colour([0xe6, 0x9f, 0x00]);
pub(crate) const SKY: Colour = Colour([0x56, 0xb4, 0xe9]);
pub(crate) const GREEN: Colour = Colour([0x00, 0x9e, 0x73]);
pub(crate) const YELLOW: Colour = Colour([0xf0, 0xe4, 0x42]);
pub(crate) const BLUE: Colour = Colour([0x00, 0x72, 0xb2]);
pub(crate) const VERMILION: Colour = Colour([0xd5, 0x5e, 0x00]);
pub(crate) const PURPLE: Colour = Colour([0xcc, 0x79, 0xa7]);

/// The colours of unimportant stationary types: two greys and two browns.
pub(crate) const SLATE: Colour = Colour([0x6c, 0x75, 0x86]);
pub(crate) const STONE: Colour = Colour([0x9a, 0x9c, 0xa3]);
pub(crate) const EARTH: Colour = Colour([0xb5, 0x93, 0x68]);
pub(crate) const WOOD: Colour = Colour([0xc9, 0x92, 0x4a]);

impl Colour {
    /// Returns this colour mixed with `share` percent of `other`.
    pub(crate) fn mixed(self, other: Colour, share: u32) -> Colour {
        let blend =
            |a: u8, b: u8| (u32::from(a) * (100 - share) + u32::from(b) * share).div_euclid(100) as u8;
        Colour(std::array::from_fn(|at| blend(self.0[at], other.0[at])))
    }

    /// Returns a lighter colour of the same hue.
    pub(crate) fn light(self) -> Colour {
        self.mixed(PAPER, 45)
    }

    /// Returns a darker colour of the same hue, or a lighter one if this colour is already dark.
    pub(crate) fn shade(self) -> Colour {
        if self.luma() < 60 { self.mixed(PAPER, 35) } else { self.mixed(INK, 40) }
    }

    /// Returns the luma, from 0 to 255 (with the weights of ITU-R BT.601).
    pub(crate) fn luma(self) -> u32 {
        let [red, green, blue] = self.0.map(u32::from);
        (299 * red + 587 * green + 114 * blue) / 1000
    }

    /// Returns the squared distance to another colour, with equal weights for red, green and blue.
    pub(crate) fn distance(self, other: Colour) -> u32 {
        self.0.iter().zip(other.0).map(|(a, b)| u32::from(a.abs_diff(b)).pow(2)).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mixing_ends_where_it_says() {
        assert_eq!((INK.mixed(PAPER, 0), INK.mixed(PAPER, 100)), (INK, PAPER));
        assert!(INK.shade().luma() > INK.luma() && PAPER.shade().luma() < PAPER.luma());
        assert_eq!(Colour([0, 0, 0]).distance(Colour([3, 4, 0])), 25);
    }
}
