//! The page, built from `viewer/` and kept here, so that a user needs nothing but this program.

/// The page itself.
pub const HTML: &str = include_str!("page/index.html");
/// What it does.
pub const SCRIPT: &str = include_str!("page/viewer.js");
/// What it looks like.
pub const STYLE: &str = include_str!("page/viewer.css");

/// Where the page asks for the other two.
const STYLE_HERE: &str = "<link rel=\"stylesheet\" href=\"viewer.css\">";
const SCRIPT_HERE: &str = "<script src=\"viewer.js\"></script>";

/// What a page of its own may load: nothing.
const POLICY: &str = "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src 'unsafe-inline'; \
                      style-src 'unsafe-inline'; img-src data: blob:\">";

/// The page as one file, with what it shows in it, as JSON.
pub fn alone(recorded: &str) -> String {
    // In a script `<` may begin its end; in JSON it stands only inside of strings.
    let recorded = recorded.replace('<', "\\u003c");
    let style = format!("{POLICY}\n<style>{STYLE}</style>");
    let script = format!(
        "<script id=\"recording\" type=\"application/json\">{recorded}</script>\n<script>{SCRIPT}</script>"
    );
    HTML.replacen(STYLE_HERE, &style, 1).replacen(SCRIPT_HERE, &script, 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_of_its_own_asks_for_nothing() {
        let page = alone("{\"name\":\"</script><b>\"}");
        assert!(page.contains("{\"name\":\"\\u003c/script>\\u003cb>\"}"));
        for outside in ["href=\"viewer", "src=\"viewer"] {
            assert!(HTML.contains(outside) && !page.contains(outside), "{outside}");
        }
        assert_eq!(page.matches("</script").count(), 2, "a script ends early");
    }
}
