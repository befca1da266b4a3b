//! Memory of large arrays that are read in no order.
//!
//! A ray jumps through a tree of tens of megabytes. With pages of 4 kB nearly every jump also has to look up where the
//! page is; with pages of 2 MB, which Linux gives where it is asked, nearly none.

/// Below this many bytes it makes no difference.
const LARGE: usize = 4 << 20;

/// An empty list with room for `len` things, on large pages where they help and the system has them.
pub(crate) fn with_room<T>(len: usize) -> Vec<T> {
    let list: Vec<T> = Vec::with_capacity(len);
    let bytes = len * size_of::<T>();
    if bytes >= LARGE {
        ask_for_large_pages(list.as_ptr().cast(), bytes);
    }
    list
}

#[cfg(target_os = "linux")]
fn ask_for_large_pages(start: *const u8, bytes: usize) {
    // The largest page size in use that advice must be aligned to.
    const ALIGN: usize = 64 << 10;
    let skip = start.align_offset(ALIGN);
    if skip < bytes {
        let len = (bytes - skip) / ALIGN * ALIGN;
        // SAFETY: The range lies within an allocation of our own. The advice changes no content, and only how the system
        // backs it; where it refuses, nothing happens.
        unsafe { libc::madvise(start.add(skip).cast_mut().cast(), len, libc::MADV_HUGEPAGE) };
    }
}

#[cfg(not(target_os = "linux"))]
fn ask_for_large_pages(_: *const u8, _: usize) {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_lists_are_lists_like_others() {
        for len in [0, 1, LARGE / 8 - 1, LARGE / 8, LARGE + 12_345] {
            let mut list = with_room::<u64>(len);
            assert!(list.is_empty() && list.capacity() >= len);
            list.extend(0..len as u64);
            assert!(list.into_iter().eq(0..len as u64));
        }
    }
}
