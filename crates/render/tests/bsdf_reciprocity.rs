//! What no BSDF may do: depend on the direction of light (hard case M-05).

use residual_render::bsdf::{
    Bsdf, BsdfKind, BsdfProposal, BsdfValue, Diffuse, DirectionalAlbedo, Fresnel, Mix,
    RoughDiffuse, Roughness, Sum,
};
use residual_render::domain::Scalar;
use residual_render::math::vec3::vec3;
use residual_render::math::{Color, Vec3};
use residual_render::surface::Surface;
use residual_render::texture::Const;

use crate::support::Worst;
use crate::support::bsdfs::{Facets, WHITE, conductor, metal, phong, view};
use crate::support::random::Rng;
use crate::support::scenes::{FLOOR, floor, scene};

/// f(wo, wi) = f(wi, wo), relative to their size; values hold a cosine of `wi` that is divided out.
fn asymmetry<B: for<'a> Bsdf<Scalar<'a>>>(name: &str, bsdf: &B) {
    let data = scene(&[FLOOR]);
    let buffers = data.buffers();
    let d = Scalar::new(&buffers);
    let surface = floor(d);
    let mut rng = Rng::new(91);
    let mut worst = Worst::default();
    for k in 0..100_000 {
        let low = if k % 2 == 0 { -4.0 } else { -0.7 };
        let mut direction = || {
            let cos = 10.0_f64.powf(rng.range(low, 0.0));
            view(cos, rng.range(0.0, std::f64::consts::TAU))
        };
        let (a, mut b) = (direction(), direction());
        if k % 3 == 0 {
            // Near the mirrored direction, where lobes are.
            b = (vec3(-a.x, -a.y, a.z) + b.scale(0.02)).normalize(d);
        }
        let there = f64::from(bsdf.eval(d, &surface, a, b).value.x) / f64::from(b.z);
        let back = f64::from(bsdf.eval(d, &surface, b, a).value.x) / f64::from(a.z);
        let size = there.max(back);
        let error = if size == 0.0 {
            0.0
        } else {
            (there - back).abs() / size
        };
        worst.add(if size < 1e-30 { 0.0 } else { error }, || {
            format!("{a:?} {b:?}: {there} {back}")
        });
    }
    worst.assert_below(1e-4, &format!("{name}: asymmetry, relative"));
}

/// Facets without what they throw at one another, which is scaled by what is seen from `wo` alone.
struct SingleReflection(Facets);

impl<'a> Bsdf<Scalar<'a>> for SingleReflection {
    fn eval(
        &self,
        d: Scalar<'a>,
        surface: &Surface<Scalar<'a>>,
        wo: Vec3<f32>,
        wi: Vec3<f32>,
    ) -> BsdfValue<Scalar<'a>> {
        let BsdfValue { value, pdf } = self.0.eval(d, surface, wo, wi);
        let ggx = self.0.roughness.microfacets(d, surface);
        let curve = self.0.fresnel.curve(d, surface, wo.z);
        let all = DirectionalAlbedo::new(d, &ggx, wo.z).compensation(d, &curve);
        let value = vec3(value.x / all.x, value.y / all.y, value.z / all.z);
        BsdfValue { value, pdf }
    }

    fn propose(
        &self,
        d: Scalar<'a>,
        surface: &Surface<Scalar<'a>>,
        wo: Vec3<f32>,
        u: [f32; 3],
    ) -> BsdfProposal<Scalar<'a>> {
        self.0.propose(d, surface, wo, u)
    }

    fn albedo(&self, d: Scalar<'a>, surface: &Surface<Scalar<'a>>, wo: Vec3<f32>) -> Color<f32> {
        self.0.albedo(d, surface, wo)
    }

    fn kind(&self) -> BsdfKind {
        BsdfKind {
            scatters: true,
            delta: false,
        }
    }
}

#[test]
fn reciprocity() {
    for roughness in [0.05, 0.1, 0.3, 1.0] {
        let gold = SingleReflection(metal([0.5; 3], roughness));
        asymmetry(&format!("conductor {roughness}"), &gold);
    }
    for exponent in [1.0, 20.0, 100.0] {
        asymmetry(&format!("phong {exponent}"), &phong(exponent));
    }
    for roughness in [0.0, 0.3, 1.0] {
        let clay = RoughDiffuse {
            albedo: Const([0.7; 3]),
            roughness: Const(roughness),
        };
        asymmetry(&format!("clay {roughness}"), &clay);
    }
    let mix = Mix {
        a: Diffuse { albedo: WHITE },
        b: SingleReflection(conductor(0.2)),
        weight: Const(0.4),
    };
    asymmetry("mix", &mix);
    asymmetry(
        "sum",
        &Sum {
            a: phong(7.0),
            b: mix,
            probability: Const(0.7),
        },
    );
}
