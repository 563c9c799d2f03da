//! Efforts of all joints at once.

use crate::names::Labels;
use crate::tree::Tree;

pub(super) fn efforts(tree: &Tree, labels: &Labels) -> Vec<String> {
    let driven = tree.links.iter().zip(&labels.links).filter(|(moving, _)| moving.is_driven());
    let efforts: Vec<&str> = driven.map(|(_, label)| label.tau.as_str()).collect();
    if efforts.is_empty() {
        return Vec::new();
    }
    let count = efforts.len();
    let mut lines = vec![
        String::new(),
        "#[allow(dead_code, reason = \"for those who set efforts, as described\")]".to_owned(),
        format!("impl {} {{", labels.robot),
        "    /// Names of the efforts, as `inputs_for` takes them.".to_owned(),
        format!("    pub const EFFORTS: [&str; {count}] = ["),
    ];
    lines.extend(efforts.iter().map(|name| format!("        \"{name}\",")));
    lines.extend(["    ];", "", "    /// Sets the efforts, in the order of `EFFORTS`."].map(str::to_owned));
    lines.push(format!("    pub fn set_efforts(&mut self, efforts: &[f64; {count}]) {{"));
    lines.extend(efforts.iter().enumerate().map(|(k, name)| format!("        self.{name} = efforts[{k}];")));
    lines.extend(["    }", "}"].map(str::to_owned));
    lines
}
