//! Which golden pictures are accepted anew.

/// Which golden pictures are replaced by what is drawn.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Bless {
    /// None.
    Nothing,
    /// Those that fail.
    Failing,
    /// All.
    All,
    /// Those whose name contains the text, or matches it as a whole if it has a `*`.
    Matching(String),
}

impl Bless {
    /// Reads the value of the environment variable `SNELL_BLESS`; `ci` says whether `CI` is set.
    ///
    /// # Errors
    /// Something is to be blessed where `CI` is set: nobody looks at it there.
    pub fn from_env(value: Option<&str>, ci: bool) -> Result<Self, String> {
        let bless = match value {
            None | Some("") => return Ok(Self::Nothing),
            Some("1") => Self::Failing,
            Some("all") => Self::All,
            Some(pattern) => Self::Matching(pattern.into()),
        };
        if ci {
            return Err(
                "SNELL_BLESS is refused because CI is set: golden pictures are blessed by who looks at them".into()
            );
        }
        Ok(bless)
    }

    pub(super) fn wants(&self, name: &str, passes: bool) -> bool {
        match self {
            Self::Nothing => false,
            Self::Failing => !passes,
            Self::All => true,
            Self::Matching(pattern) => matches(pattern, name),
        }
    }
}

/// Whether a name contains a text, or matches it as a whole if it has a `*`, which stands for anything.
fn matches(pattern: &str, name: &str) -> bool {
    let Some((start, rest)) = pattern.split_once('*') else { return name.contains(pattern) };
    let Some(name) = name.strip_prefix(start) else { return false };
    // Every piece but the last takes its first place: that leaves the most for the others.
    let mut pieces: Vec<_> = rest.split('*').collect();
    let last = pieces.pop().unwrap_or_default();
    let found = pieces.iter().try_fold(name, |name, piece| name.split_once(piece).map(|(_, after)| after));
    found.is_some_and(|name| name.ends_with(last))
}
