//! What a sensor's web server tells.

use super::scaling::{RdtScaling, RdtScalingError};
use crate::unit::{Dimension, Unit};

/// What `http://<sensor>/netftapi2.xml` tells of an ATI sensor: its scaling with the units that are set, and its rates.
///
/// ```
/// let text = "<netft><cfgcpf>1000000</cfgcpf><cfgcpt>999</cfgcpt><scfgfu>N</scfgfu><scfgtu>Nmm</scfgtu>\
///     <comrdtrate>1000</comrdtrate><runrate>7000</runrate></netft>";
/// let found = rod_hw::rdt::RdtConfiguration::from_xml(text)?;
/// assert_eq!(found.scaling.factors()[3], 1e-3 / 999.0); // N m a count
/// assert_eq!((found.record_rate, found.clock_rate), (Some(1000.0), Some(7000.0)));
/// # Ok::<(), rod_hw::rdt::RdtScalingError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RdtConfiguration {
    /// What a count is. Its [`scale`](RdtScaling::scale) is not told here and 1.
    pub scaling: RdtScaling,
    /// Rate of the records, Hz, if it is told.
    pub record_rate: Option<f64>,
    /// Rate of the sensor's own clock, Hz, if it is told; for [`RdtSettings::clock_rate`](super::RdtSettings::clock_rate).
    pub clock_rate: Option<f64>,
}

impl RdtConfiguration {
    /// From the text of `netftapi2.xml`. Getting it is left to you: `curl http://192.168.1.1/netftapi2.xml`.
    ///
    /// # Errors
    /// [`RdtScalingError`].
    pub fn from_xml(text: &str) -> Result<Self, RdtScalingError> {
        let document = roxmltree::Document::parse(text).map_err(|error| RdtScalingError::Xml(error.to_string()))?;
        let find = |field: &'static str, expected| {
            let mut nodes = document.descendants().filter(|node| node.has_tag_name(field));
            let found = match (nodes.next(), nodes.next()) {
                (None, _) => "missing",
                (Some(_), Some(_)) => "there twice",
                (Some(node), None) => return Ok(node.text().unwrap_or_default().trim().to_owned()),
            };
            Err(RdtScalingError::Field { field, found: found.into(), expected })
        };
        let number = |field: &'static str| {
            let text = find(field, "number")?;
            let wrong = |_| RdtScalingError::Field { field, found: format!("`{text}`"), expected: "number" };
            text.parse::<f64>().map_err(wrong)
        };
        let unit = |field: &'static str, dimension| {
            Unit::parse(&find(field, "unit")?, dimension).map_err(|cause| RdtScalingError::UnitName { field, cause })
        };
        let rate = |field| number(field).ok().filter(|rate| *rate > 0.0 && rate.is_finite());
        Ok(Self {
            scaling: RdtScaling::new(
                (unit("scfgfu", Dimension::Force)?, number("cfgcpf")?),
                (unit("scfgtu", Dimension::Torque)?, number("cfgcpt")?),
            )?,
            record_rate: rate("comrdtrate"),
            clock_rate: rate("runrate"),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(cpf: &str, force: &str, torque: &str) -> String {
        format!(
            "<?xml version=\"1.0\"?><netft><prodname>Net F/T</prodname><cfgcpf>{cpf}</cfgcpf><cfgcpt> 1000 </cfgcpt>\
             <scfgfu>{force}</scfgfu><scfgtu>{torque}</scfgtu></netft>"
        )
    }

    #[test]
    fn spellings_of_the_vendor() {
        for (force, torque) in
            [("N", "N-m"), ("N", "Nm"), ("lbf", "lbf-in"), ("klbf", "lbf-ft"), ("kN", "kN-m"), ("kgf", "kg-cm")]
        {
            let found = RdtConfiguration::from_xml(&text("1000000", force, torque)).unwrap();
            assert_eq!((found.scaling.counts_per_force, found.scaling.counts_per_torque), (1e6, 1e3));
            assert_eq!((found.record_rate, found.clock_rate), (None, None));
        }
    }

    #[test]
    fn refused() {
        for (text, message) in [
            (text("1", "N", "N"), "`scfgtu` of netftapi2.xml: `N` is a unit of force, expected one of torque: N m"),
            (text("1", "furlong", "Nm"), "`scfgfu` of netftapi2.xml: `furlong` is no unit that is known"),
            (text("many", "N", "Nm"), "`cfgcpf` of netftapi2.xml is `many`, expected one number"),
            (text("", "N", "Nm"), "`cfgcpf` of netftapi2.xml is ``, expected one number"),
            (text("0", "N", "Nm"), "0 counts per unit of force, expected more than 0"),
            (text("NaN", "N", "Nm"), "NaN counts per unit of force, expected more than 0"),
            (text("1</cfgcpf><cfgcpf>2", "N", "Nm"), "`cfgcpf` of netftapi2.xml is there twice, expected one number"),
            ("<netft><cfgcpf>1</cfgcpf></netft>".into(), "`scfgfu` of netftapi2.xml is missing, expected one unit"),
            ("<html><p>404".into(), "netftapi2.xml cannot be read: "),
        ] {
            let error = RdtConfiguration::from_xml(&text).unwrap_err().to_string();
            assert!(error.starts_with(message), "{error}");
        }
    }
}
