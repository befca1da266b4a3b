//! A stack of fixed size that costs nothing until it is used.

use core::mem::MaybeUninit;

/// Where up to `N` entries of a stack are kept.
pub(crate) struct Room<const N: usize>([MaybeUninit<u64>; N]);

impl<const N: usize> Room<N> {
    #[inline(always)]
    pub(crate) fn new() -> Self {
        Self([const { MaybeUninit::uninit() }; N])
    }
}

/// A stack; its entries beyond `len` are not initialised. They stand elsewhere, so that `len` is kept in a register.
pub(crate) struct Stack<'a, const N: usize> {
    entries: &'a mut [MaybeUninit<u64>; N],
    len: usize,
}

impl<'a, const N: usize> Stack<'a, N> {
    /// An empty stack.
    #[inline(always)]
    pub(crate) fn new(Room(entries): &'a mut Room<N>) -> Self {
        Self { entries, len: 0 }
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
