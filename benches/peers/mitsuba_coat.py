"""A coat over a matte base, as a BSDF of Mitsuba 3: a reflection by GGX facets with Schlick's curve, and under it what it leaves.

Mitsuba has two of its own, which scatter differently: `principled` takes nothing from its base for what its coat reflects, and
`roughplastic` also takes what its coat reflects of the light that arrives. Kernels have this one compiled like those.

Properties: `base_color`, a texture; `alpha` of GGX; `normal`, what facets reflect at normal incidence; `albedo`, numbers with
spaces between them: what the coat reflects in all, at evenly spaced cosines from 0 to 1.
"""

import drjit as dr
import mitsuba as mi

# As often as this the coat is sampled at least.
LEAST_COAT = 0.1


class Coat(mi.BSDF):
    def __init__(self, props):
        mi.BSDF.__init__(self, props)
        self.base_color = props.get_texture("base_color", 0.5)
        self.normal = mi.Float(props["normal"])
        self.facets = mi.MicrofacetDistribution(mi.MicrofacetType.GGX, props["alpha"])
        albedos = [float(number) for number in props["albedo"].split()]
        self.albedos = mi.Float(albedos) if dr.is_jit_v(mi.Float) else albedos
        self.last = len(albedos) - 1
        base = mi.BSDFFlags.DiffuseReflection | mi.BSDFFlags.FrontSide
        coat = mi.BSDFFlags.GlossyReflection | mi.BSDFFlags.FrontSide
        self.m_components = [base, coat]
        self.m_flags = base | coat

    def coat_albedo(self, cos):
        place = dr.clip(cos, 0, 1) * self.last
        index = dr.minimum(mi.UInt32(place), self.last - 1)
        return dr.lerp(self.tabulated(index), self.tabulated(index + 1), place - index)

    def tabulated(self, index):
        if dr.is_jit_v(mi.Float):
            return dr.gather(mi.Float, self.albedos, index)
        return self.albedos[index]

    def layers(self, si, active):
        """The base's colour, what the coat leaves, and how often it is sampled."""
        color = self.base_color.eval(si, active)
        coat = self.coat_albedo(mi.Frame3f.cos_theta(si.wi))
        base = (1 - coat) * dr.max(color)
        return color, 1 - coat, dr.clip(coat / dr.maximum(coat + base, 1e-9), LEAST_COAT, 1)

    def eval_pdf(self, ctx, si, wo, active=True):
        cos_i, cos_o = mi.Frame3f.cos_theta(si.wi), mi.Frame3f.cos_theta(wo)
        active &= (cos_i > 0) & (cos_o > 0)
        color, under, share = self.layers(si, active)
        half = dr.normalize(si.wi + wo)
        fresnel = self.normal + (1 - self.normal) * (1 - dr.dot(si.wi, half)) ** 5
        facets = self.facets.eval(half) * self.facets.G(si.wi, wo, half) / (4 * cos_i)
        value = color * (under * dr.inv_pi * cos_o) + fresnel * facets
        of_coat = self.facets.pdf(si.wi, half) / (4 * dr.dot(wo, half))
        of_base = mi.warp.square_to_cosine_hemisphere_pdf(wo)
        pdf = dr.lerp(of_base, of_coat, share)
        return dr.select(active, value, 0), dr.select(active, pdf, 0)

    def eval(self, ctx, si, wo, active=True):
        return self.eval_pdf(ctx, si, wo, active)[0]

    def pdf(self, ctx, si, wo, active=True):
        return self.eval_pdf(ctx, si, wo, active)[1]

    def sample(self, ctx, si, sample1, sample2, active=True):
        active &= mi.Frame3f.cos_theta(si.wi) > 0
        _, _, share = self.layers(si, active)
        is_coat = sample1 < share
        half, _ = self.facets.sample(si.wi, sample2)
        of_base = mi.warp.square_to_cosine_hemisphere(sample2)
        bs = mi.BSDFSample3f()
        bs.wo = dr.select(is_coat, mi.reflect(si.wi, half), of_base)
        value, bs.pdf = self.eval_pdf(ctx, si, bs.wo, active)
        bs.eta = 1
        bs.sampled_component = dr.select(is_coat, mi.UInt32(1), mi.UInt32(0))
        glossy, diffuse = (mi.UInt32(+flag) for flag in (mi.BSDFFlags.GlossyReflection, mi.BSDFFlags.DiffuseReflection))
        bs.sampled_type = dr.select(is_coat, glossy, diffuse)
        active &= bs.pdf > 0
        return bs, dr.select(active, value / dr.maximum(bs.pdf, 1e-30), 0)

    def to_string(self):
        return "Coat[]"


def register():
    mi.register_bsdf("coat", Coat)
