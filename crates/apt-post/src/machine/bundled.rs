//! The machines that come with the program.

use super::{MachineDefinition, MachineError, MachineInfo};

/// The definitions that come with the program.
const BUNDLED: [&str; 9] = [
    include_str!("../../machines/linuxcnc-mill3.toml"),
    include_str!("../../machines/fanuc-mill3.toml"),
    include_str!("../../machines/haas-mill3.toml"),
    include_str!("../../machines/heidenhain-mill3.toml"),
    include_str!("../../machines/linuxcnc-mill5.toml"),
    include_str!("../../machines/fanuc-mill5.toml"),
    include_str!("../../machines/haas-mill5.toml"),
    include_str!("../../machines/sinumerik-mill5.toml"),
    include_str!("../../machines/heidenhain-mill5.toml"),
];

/// The bundled machines, in a fixed order.
pub fn machines() -> Vec<MachineInfo> {
    BUNDLED
        .iter()
        .filter_map(|text| MachineDefinition::from_toml(text).ok())
        .map(|machine| machine.info())
        .collect()
}

/// A bundled machine.
///
/// # Errors
/// A name that no bundled machine has.
pub fn machine(name: &str) -> Result<MachineDefinition, MachineError> {
    bundled(name).map(|(machine, _)| machine)
}

/// The definition file of a bundled machine, to begin another one with.
///
/// # Errors
/// A name that no bundled machine has.
pub fn definition_file(name: &str) -> Result<&'static str, MachineError> {
    bundled(name).map(|(_, text)| text)
}

fn bundled(name: &str) -> Result<(MachineDefinition, &'static str), MachineError> {
    for text in BUNDLED {
        let machine = MachineDefinition::from_toml(text)?;
        if machine.id == name || machine.machin.iter().any(|known| known.eq_ignore_ascii_case(name)) {
            return Ok((machine, text));
        }
    }
    Err(MachineError::UnknownMachine { name: name.to_owned() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bundled_definition_is_valid() {
        for text in BUNDLED {
            let machine = MachineDefinition::from_toml(text).unwrap();
            assert_eq!(super::machine(&machine.id).unwrap(), machine);
        }
        let names: Vec<String> = machines().into_iter().map(|info| info.name).collect();
        let three = ["linuxcnc-mill3", "fanuc-mill3", "haas-mill3", "heidenhain-mill3"];
        let five = ["linuxcnc-mill5", "fanuc-mill5", "haas-mill5", "sinumerik-mill5", "heidenhain-mill5"];
        assert_eq!(names, [&three[..], &five].concat());
        // The names of MACHIN lead to one machine each.
        let of_programs: Vec<String> = ["LINCNC", "LinuxCNC", "fanuc", "HAAS", "Heiden"]
            .map(|name| super::machine(name).unwrap().id)
            .into();
        assert_eq!(
            of_programs,
            ["linuxcnc-mill3", "linuxcnc-mill3", "fanuc-mill3", "haas-mill3", "heidenhain-mill3"]
        );
        assert_eq!(super::machine("x"), Err(MachineError::UnknownMachine { name: "x".to_owned() }));
    }

    #[test]
    fn mistakes_name_line_and_key() {
        let text = BUNDLED[0].replace("max_block", "max_blok");
        let Err(MachineError::Syntax { line: Some(line), message }) = MachineDefinition::from_toml(&text)
        else {
            panic!("accepted");
        };
        assert!(text.lines().nth(line).unwrap().starts_with("max_blok"), "{line}");
        assert!(message.contains("max_blok"), "{message}");
        let text = BUNDLED[0].replace("{!Z}", "{!W}");
        assert!(
            matches!(MachineDefinition::from_toml(&text), Err(MachineError::UnknownRegister { register, .. }) if register == "W")
        );
        let text = BUNDLED[0].replace("schema = 1", "schema = 7");
        assert_eq!(MachineDefinition::from_toml(&text), Err(MachineError::Schema { found: 7 }));
    }
}
