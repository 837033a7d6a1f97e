//! What a node's slot holds, in 32 bits.

/// A child as stored: the index of a node, or with the high bit set a leaf, `count` packets from
/// `first` on. A leaf of no packets is a vacant slot: entering it is harmless.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) struct Child(pub(crate) u32);

impl Child {
    const LEAF: u32 = 1 << 31;
    const FIRST_BITS: u32 = 27;
    pub(crate) const MAX_PACKETS: usize = 15;
    pub(crate) const VACANT: Child = Child(Child::LEAF);
    pub(crate) const ROOT: Child = Child(0);

    pub(crate) fn node(index: usize) -> Child {
        assert!(index < Child::LEAF as usize, "too many nodes");
        Child(index as u32)
    }

    pub(crate) fn leaf(first: usize, count: usize) -> Child {
        assert!(
            first + count <= 1 << Child::FIRST_BITS,
            "too many triangle packets"
        );
        assert!(count <= Child::MAX_PACKETS);
        Child(Child::LEAF | (count as u32) << Child::FIRST_BITS | first as u32)
    }

    #[inline(always)]
    pub(crate) fn is_leaf(self) -> bool {
        self.0 & Child::LEAF != 0
    }

    #[inline(always)]
    pub(crate) fn first_packet(self) -> usize {
        (self.0 & ((1 << Child::FIRST_BITS) - 1)) as usize
    }

    /// A leaf of two packets or more, but for the first.
    #[inline(always)]
    pub(crate) fn without_first_packet(self) -> Child {
        // One more in the low bits, and one less in the count.
        Child(self.0.wrapping_add(1).wrapping_sub(1 << Child::FIRST_BITS))
    }

    #[inline(always)]
    pub(crate) fn packet_count(self) -> usize {
        (self.0 >> Child::FIRST_BITS & 15) as usize
    }
}
