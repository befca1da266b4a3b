//! A stack of fixed size that costs nothing until it is used.

use core::mem::MaybeUninit;

/// Up to `N` entries; those beyond `len` are not initialised.
pub(crate) struct Stack<const N: usize> {
    entries: [MaybeUninit<u64>; N],
    len: usize,
}

impl<const N: usize> Stack<N> {
    #[inline(always)]
    pub(crate) fn new() -> Self {
        Self { entries: [const { MaybeUninit::uninit() }; N], len: 0 }
    }

    /// Adds an entry; there must be room.
    #[inline(always)]
    pub(crate) fn push(&mut self, entry: u64) {
        self.entries[self.len] = MaybeUninit::new(entry);
        self.len += 1;
    }

    /// Takes the entry added last.
    #[inline(always)]
    pub(crate) fn pop(&mut self) -> Option<u64> {
        self.len = self.len.checked_sub(1)?;
        // SAFETY: `push` wrote every entry below the former `len`.
        Some(unsafe { self.entries[self.len].assume_init() })
    }

    #[inline(always)]
    pub(crate) fn len(&self) -> usize {
        self.len
    }

    /// The entries added from the `from`th on.
    #[inline(always)]
    pub(crate) fn since(&mut self, from: usize) -> &mut [u64] {
        // SAFETY: `push` wrote every entry below `len`.
        unsafe { self.entries[from..self.len].assume_init_mut() }
    }
}
