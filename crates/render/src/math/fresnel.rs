//! How much a smooth interface reflects: the Fresnel equations of dielectrics, and Schlick's approximation.

use crate::domain::Domain;

/// (1 − cos)⁵, Schlick's weight.
#[inline(always)]
pub fn schlick_weight<D: Domain>(d: D, cos: D::F) -> D::F {
    let m = d.max(d.lit(1.0) - cos, d.lit(0.0));
    let m2 = m * m;
    m2 * m2 * m
}

/// Schlick's approximation of the reflectance at an angle of this cosine, from those at normal and at grazing incidence.
#[inline(always)]
pub fn schlick<D: Domain>(d: D, normal: D::F, grazing: D::F, cos: D::F) -> D::F {
    d.fma(grazing - normal, schlick_weight(d, cos), normal)
}

/// Fresnel reflectance of unpolarised light and the quantity √(η² − 1 + cos²), η times the cosine of the
/// refracted ray; `cos` ≥ 0, `eta` = index beyond ÷ index here. On total reflection (1, 0).
///
/// Written without cancellation near η = 1 (hard case M-06).
#[inline(always)]
pub fn fresnel<D: Domain>(d: D, cos: D::F, eta: D::F) -> (D::F, D::F) {
    let one = d.lit(1.0);
    let q = (eta - one) * (eta + one);
    let c2 = cos * cos;
    let g2 = q + c2;
    let total = d.le(g2, d.lit(0.0));
    let g = d.sqrt(d.max(g2, d.lit(0.0)));
    let eta2 = eta * eta;
    let perpendicular = cos + g;
    let parallel = d.fma(eta2, cos, g);
    let rs = q / (perpendicular * perpendicular);
    let rp = q * d.fma(eta2 + one, c2, -one) / (parallel * parallel);
    let reflectance = d.lit(0.5) * d.fma(rs, rs, rp * rp);
    (
        d.select(total, one, d.min(reflectance, one)),
        d.select(total, d.lit(0.0), g),
    )
}
