//! What the records of all kinds of lights have in common.

use super::area::AreaRecord;
use super::area_by_solid_angle::AreaBySolidAngleRecord;
use super::pick::LightRecord;
use super::punctual::PunctualRecord;

/// The kind is read before it is known which record it belongs to.
#[test]
fn every_record_begins_with_the_kind() {
    let kind = LightRecord::offsets().kind;
    assert_eq!(kind, AreaRecord::offsets().kind);
    assert_eq!(kind, AreaBySolidAngleRecord::offsets().kind);
    assert_eq!(kind, PunctualRecord::offsets().kind);
}
