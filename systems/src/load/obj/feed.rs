//! What the parser reads: a file's statements, checked and rewritten one by one as the parser asks for them.
//!
//! The file is read once and never held as a whole; the parser sees nothing that it is not known to handle.

use super::lines::{Line, Lines};
use super::log::Log;
use std::io::{self, BufRead, Read};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Bytes made ready at a time.
const BLOCK: usize = 1 << 16;

/// The checks of one kind of file.
pub(super) trait Check {
    /// Checks one line and appends what the parser is to read for it.
    fn line(&mut self, line: &Line<'_>, out: &mut Vec<u8>);

    /// Checks what can be known only at the end of the file.
    fn finish(&mut self);

    /// Where findings go.
    fn report(&mut self) -> &mut Log;
}

/// A reader of checked statements.
pub(super) struct Feed<'a, R, C> {
    lines: Lines<R>,
    check: &'a mut C,
    ready: Vec<u8>,
    given: usize,
    error: Option<io::Error>,
}

impl<'a, R: BufRead, C: Check> Feed<'a, R, C> {
    /// Runs a parser on the checked statements of a file, all of which are checked even if the parser stops early.
    /// Nothing if the check found faults.
    ///
    /// # Errors
    /// The file could not be read, or the parser failed or crashed on what had passed the check.
    pub(super) fn parse<T>(
        reader: R,
        check: &'a mut C,
        parser: impl FnOnce(&mut Self) -> Result<T, tobj::LoadError>,
    ) -> Result<Option<T>, String> {
        let mut feed = Self { lines: Lines::new(reader), check, ready: vec![], given: 0, error: None };
        let parsed = catch_unwind(AssertUnwindSafe(|| parser(&mut feed)));
        while feed.refill() {}
        if let Some(error) = feed.error {
            return Err(format!("cannot be read: {error}"));
        }
        feed.check.finish();
        if feed.check.report().has_faults() {
            return Ok(None);
        }
        match parsed {
            Ok(Ok(parsed)) => Ok(Some(parsed)),
            Ok(Err(error)) => Err(format!("cannot be parsed: {error}")),
            Err(_) => Err("cannot be parsed: the parser crashed".into()),
        }
    }

    /// Makes the next statements ready; false at the end of the file.
    fn refill(&mut self) -> bool {
        self.ready.clear();
        self.given = 0;
        loop {
            match self.lines.next() {
                Ok(Some(line)) => self.check.line(&line, &mut self.ready),
                Ok(None) => return !self.ready.is_empty(),
                Err(error) => {
                    self.error.get_or_insert(error);
                    return false;
                }
            }
            // A faulty file is checked to its end; parsing it on would only cost time.
            if self.check.report().has_faults() {
                self.ready.clear();
            }
            if self.ready.len() >= BLOCK {
                return true;
            }
        }
    }
}

impl<R: BufRead, C: Check> Read for Feed<'_, R, C> {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        let len = self.fill_buf()?.read(out)?;
        self.consume(len);
        Ok(len)
    }
}

impl<R: BufRead, C: Check> BufRead for Feed<'_, R, C> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        if self.given == self.ready.len() {
            self.refill();
        }
        Ok(&self.ready[self.given..])
    }

    fn consume(&mut self, amount: usize) {
        self.given += amount;
    }
}
