//! Generates the configuration of zenoh's access control: it says who may send and receive what. Everything that is not
//! listed is denied. A client is identified by the common name of its certificate, so there is access control only with
//! TLS. A rule allows a key expression only if it allows every key that matches the expression. So a client reaches no
//! further keys with a wildcard.

use crate::json::{string, strings};
use crate::settings::Permission;
use std::collections::BTreeMap;
use sun2xp_remote_protocol::{Action, ClientName, EVERY_STATUS, HandName};

/// One rule: messages of some kinds, in one direction, under some keys.
struct Rule {
    id: String,
    messages: &'static [&'static str],
    flow: &'static str,
    keys: Vec<String>,
}

impl Rule {
    fn json(&self) -> String {
        format!(
            r#"{{"id":{},"messages":{},"flows":["{}"],"permission":"allow","key_exprs":{}}}"#,
            string(&self.id),
            strings(self.messages),
            self.flow,
            strings(&self.keys)
        )
    }
}

/// Returns the access control at the server of this hand.
#[must_use]
pub fn at_hand(hand: &HandName, clients: &BTreeMap<ClientName, Permission>) -> String {
    let scope = Scope(hand.to_string());
    let listed = clients.iter().filter(|(_, permission)| **permission != Permission::Hand);
    control(listed.map(|(client, permission)| (client, scope.of_client(client, *permission))))
}

/// Returns the access control at a router. Clients may use every hand there. A hand may offer only the keys below its
/// name, which is the common name of its certificate.
#[must_use]
pub fn at_router(clients: &BTreeMap<ClientName, Permission>) -> String {
    let everywhere = Scope("*".into());
    control(clients.iter().map(|(client, &permission)| match permission {
        Permission::Hand => (client, Scope(client.to_string()).of_hand(client)),
        _ => (client, everywhere.of_client(client, permission)),
    }))
}

fn control<'a>(subjects: impl Iterator<Item = (&'a ClientName, Vec<Rule>)>) -> String {
    let (mut rules, mut names, mut policies) = (Vec::new(), Vec::new(), Vec::new());
    for (client, own) in subjects {
        let name = string(client.as_str());
        names.push(format!(r#"{{"id":{name},"cert_common_names":[{name}]}}"#));
        policies.push(format!(r#"{{"rules":{},"subjects":[{name}]}}"#, strings(own.iter().map(|rule| &rule.id))));
        rules.extend(own.iter().map(Rule::json));
    }
    if policies.is_empty() {
        return r#"{"enabled":true,"default_permission":"deny"}"#.into();
    }
    format!(
        r#"{{"enabled":true,"default_permission":"deny","rules":[{}],"subjects":[{}],"policies":[{}]}}"#,
        rules.join(","),
        names.join(","),
        policies.join(",")
    )
}

/// The part of a key that names the hand to which the rules apply: its name, or `*` for every hand.
struct Scope(String);

impl Scope {
    fn key(&self, rest: &str) -> String {
        format!("sun2xp/{}/{rest}", self.0)
    }

    /// The keys that a client may read, whether its permission is `Read` or `Command`.
    fn read(&self, client: &ClientName) -> Vec<String> {
        ["state", "events", "status", &format!("refused/{client}")].map(|rest| self.key(rest)).into()
    }

    fn of_client(&self, client: &ClientName, permission: Permission) -> Vec<Rule> {
        let rule = |what: &str, messages, flow, keys| Rule { id: format!("{client} {what}"), messages, flow, keys };
        let actions = Action::ALL.iter().filter(|&&action| permission == Permission::Command || action == Action::Stop);
        let mut asked: Vec<String> = actions.map(|action| self.key(&format!("{}/{client}", action.name()))).collect();
        asked.push(EVERY_STATUS.into());
        let mut rules = vec![
            rule("subscribes", &["declare_subscriber"], "ingress", self.read(client)),
            rule("receives", &["put"], "egress", self.read(client)),
            rule("asks", &["query"], "ingress", asked.clone()),
            rule("is answered", &["reply"], "egress", asked),
        ];
        if permission == Permission::Command {
            // A declared publisher sends only if it knows of a subscriber.
            rules.push(rule("is informed", &["declare_subscriber"], "egress", vec![self.key("target/*")]));
            rules.push(rule("commands", &["put"], "ingress", vec![self.key(&format!("target/{client}"))]));
        }
        rules
    }

    fn of_hand(&self, client: &ClientName) -> Vec<Rule> {
        let rule = |what: &str, messages, flow, keys| Rule { id: format!("{client} {what}"), messages, flow, keys };
        let published = || ["state", "events", "status", "refused/*"].map(|rest| self.key(rest)).to_vec();
        let targets = || vec![self.key("target/*")];
        let asked = || vec![self.key("*/*"), self.key("status")];
        vec![
            rule("publishes", &["put"], "ingress", published()),
            rule("is informed", &["declare_subscriber"], "egress", published()),
            rule("subscribes", &["declare_subscriber"], "ingress", targets()),
            rule("is commanded", &["put"], "egress", targets()),
            rule("answers", &["declare_queryable"], "ingress", asked()),
            rule("is asked", &["query"], "egress", [asked(), vec![EVERY_STATUS.into()]].concat()),
            rule("replies", &["reply"], "ingress", asked()),
        ]
    }
}

/// Returns what this client may do at the server of a hand; none if it is not listed, or listed as a hand.
#[must_use]
pub fn permission(clients: &BTreeMap<ClientName, Permission>, client: &ClientName) -> Option<Permission> {
    clients.get(client).copied().filter(|&permission| permission != Permission::Hand)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn clients(text: &[(&str, Permission)]) -> BTreeMap<ClientName, Permission> {
        text.iter().map(|(name, permission)| (name.parse().expect("a name"), *permission)).collect()
    }

    /// Lets zenoh read the access control. This checks the syntax and the names in it.
    fn read(control: &str) {
        let mut config = zenoh::Config::default();
        config.insert_json5("access_control", control).unwrap_or_else(|error| panic!("{error}: {control}"));
    }

    #[test]
    fn nobody_is_listed_and_everything_is_denied() {
        let control = at_hand(&"hand".parse().expect("a name"), &BTreeMap::new());
        read(&control);
        assert!(control.contains("\"deny\"") && !control.contains("\"allow\""));
    }

    #[test]
    fn a_reader_may_stop_and_a_commander_has_only_its_own_keys() {
        let clients = clients(&[("planner", Permission::Command), ("screen", Permission::Read)]);
        let control = at_hand(&"hand".parse().expect("a name"), &clients);
        read(&control);
        for key in ["target/planner", "acquire/planner", "stop/planner", "stop/screen", "refused/planner"] {
            assert!(control.contains(&format!("sun2xp/hand/{key}\"")), "{key}");
        }
        for key in ["target/screen", "acquire/screen", "**"] {
            assert!(!control.contains(&format!("sun2xp/hand/{key}\"")), "{key}");
        }
    }

    #[test]
    fn a_router_gives_each_hand_the_keys_below_its_name() {
        let clients = clients(&[("left", Permission::Hand), ("planner", Permission::Command)]);
        let control = at_router(&clients);
        read(&control);
        assert!(control.contains("sun2xp/left/state") && control.contains("sun2xp/*/target/planner"));
        assert!(!control.contains("sun2xp/*/target/left"));
    }
}
