//! Pages with marked slots: `{{name}}`.

use std::fmt;

/// Text that is markup already: whatever comes from outside has been escaped.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Html(String);

impl Html {
    /// Text, shown as it is, between tags or in an attribute's quotes.
    pub(super) fn text(text: &str) -> Self {
        let mut escaped = String::with_capacity(text.len());
        for c in text.chars() {
            match c {
                '&' => escaped.push_str("&amp;"),
                '<' => escaped.push_str("&lt;"),
                '>' => escaped.push_str("&gt;"),
                '"' => escaped.push_str("&quot;"),
                '\'' => escaped.push_str("&#39;"),
                _ => escaped.push(c),
            }
        }
        Self(escaped)
    }

    /// Markup of our own.
    pub(super) fn trusted(markup: &str) -> Self {
        Self(markup.to_owned())
    }
}

impl fmt::Display for Html {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl FromIterator<Html> for Html {
    fn from_iter<I: IntoIterator<Item = Html>>(parts: I) -> Self {
        Self(parts.into_iter().map(|part| part.0).collect())
    }
}

/// Fills the slots of a page. What is filled in isn't searched for slots. A slot without a value stays as it is.
pub(super) fn fill(page: &str, values: &[(&str, Html)]) -> String {
    let mut filled = String::new();
    let mut rest = page;
    while let Some((before, after)) = rest.split_once("{{") {
        filled.push_str(before);
        let slot = after.split_once("}}");
        let value = slot.and_then(|(name, _)| values.iter().find(|(key, _)| *key == name));
        rest = match (slot, value) {
            (Some((_, after)), Some((_, value))) => {
                filled.push_str(&value.0);
                after
            }
            _ => {
                filled.push_str("{{");
                after
            }
        };
    }
    filled + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_cannot_become_markup() {
        for (text, escaped) in [
            ("a < b & c", "a &lt; b &amp; c"),
            ("\"><script>", "&quot;&gt;&lt;script&gt;"),
            ("it's", "it&#39;s"),
        ] {
            assert_eq!(Html::text(text).to_string(), escaped);
        }
    }

    #[test]
    fn slots_are_filled_once_and_values_are_not_searched() {
        let values = [("a", Html::trusted("{{b}}")), ("b", Html::trusted("2"))];
        for (page, filled) in [
            ("{{a}}-{{b}}{{b}}", "{{b}}-22"),
            ("{ {{b}} } {{c}} {{", "{ 2 } {{c}} {{"),
            ("", ""),
        ] {
            assert_eq!(fill(page, &values), filled);
        }
    }
}
