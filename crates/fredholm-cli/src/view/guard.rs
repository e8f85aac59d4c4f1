//! Only this machine, and only this page: what is asked of the server by another site's page is refused.
//!
//! A page of some site can make a browser ask 127.0.0.1, under the site's own name if that is made to point here (DNS
//! rebinding). The browser then says so: in `Host` stands the site's name, in `Origin` whose page asks.

use axum::http::header::{HOST, ORIGIN};
use axum::http::{HeaderMap, HeaderValue};

/// The names under which the server is asked at its port.
#[derive(Clone, Debug)]
pub struct Guard {
    hosts: [String; 2],
}

impl Guard {
    /// At a port.
    pub fn new(port: u16) -> Self {
        Self { hosts: [format!("127.0.0.1:{port}"), format!("localhost:{port}")] }
    }

    /// Why these headers are not this page's, if they are not.
    pub fn refusal(&self, headers: &HeaderMap) -> Option<&'static str> {
        let mut hosts = headers.get_all(HOST).iter();
        match (hosts.next(), hosts.next()) {
            (Some(host), None) if self.is_here(host, "") => {}
            _ => return Some("ask for 127.0.0.1 or localhost, at the port that is served"),
        }
        let foreign = |origin: &HeaderValue| !self.is_here(origin, "http://");
        headers.get_all(ORIGIN).iter().any(foreign).then_some("the page of another site asks")
    }

    fn is_here(&self, value: &HeaderValue, before: &str) -> bool {
        let host = value.to_str().ok().and_then(|value| value.strip_prefix(before));
        host.is_some_and(|host| self.hosts.iter().any(|own| own.eq_ignore_ascii_case(host)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_let_in(headers: &[(&'static str, &'static str)]) -> bool {
        let headers = headers.iter().map(|(name, value)| (name.parse().unwrap(), value.parse().unwrap()));
        Guard::new(8731).refusal(&headers.collect()).is_none()
    }

    #[test]
    fn only_this_page_is_let_in() {
        for fine in [
            &[("host", "127.0.0.1:8731")][..],
            &[("host", "LOCALHOST:8731"), ("origin", "http://localhost:8731")],
            &[("host", "127.0.0.1:8731"), ("origin", "http://127.0.0.1:8731")],
        ] {
            assert!(is_let_in(fine), "{fine:?}");
        }
        for bad in [
            &[][..],
            &[("host", "127.0.0.1")],
            &[("host", "127.0.0.1:80")],
            &[("host", "evil.example:8731")],
            &[("host", "127.0.0.1:8731.evil.example")],
            &[("host", "127.0.0.1:8731"), ("origin", "http://evil.example")],
            &[("host", "127.0.0.1:8731"), ("origin", "https://127.0.0.1:8731")],
            &[("host", "127.0.0.1:8731"), ("origin", "http://127.0.0.1:9999")],
            &[("host", "127.0.0.1:8731"), ("origin", "null")],
        ] {
            assert!(!is_let_in(bad), "{bad:?}");
        }
    }
}
