//! Tracers around others: what they leave to the tracer within.

/// Methods of [`Tracer`](super::Tracer) that call those of the field `tracer`.
macro_rules! forward {
    ($($method:ident),* $(,)?) => {
        $($crate::tracer::forward::forward!(@ $method);)*
    };
    (@ on_emit) => {
        #[inline(always)]
        fn on_emit<C: Camera<D>, L: LightKinds<D> + ?Sized>(
            &self,
            d: D,
            camera: &C,
            lights: &L,
            pixel: [D::U; 2],
            sample: D::U,
        ) -> Path<D> {
            self.tracer.on_emit(d, camera, lights, pixel, sample)
        }

        #[inline(always)]
        fn path_origin(&self) -> Option<$crate::tracer::PathOrigin> {
            self.tracer.path_origin()
        }
    };
    (@ wavelength) => {
        #[inline(always)]
        fn wavelength(&self, d: D, path: &Path<D>) -> Option<D::F> {
            self.tracer.wavelength(d, path)
        }
    };
    (@ cone) => {
        #[inline(always)]
        fn cone(&self, d: D, path: &Path<D>) -> Option<$crate::surface::Cone<D>> {
            self.tracer.cone(d, path)
        }
    };
    (@ crossing) => {
        #[inline(always)]
        fn crossing(
            &self,
            d: D,
            path: &Path<D>,
            surface: &Surface<D>,
            interior: D::U,
        ) -> Option<$crate::tracer::Crossing<D>> {
            self.tracer.crossing(d, path, surface, interior)
        }
    };
    (@ passage) => {
        #[inline(always)]
        fn passage(
            &self,
            d: D,
            path: &Path<D>,
            surface: &Surface<D>,
        ) -> Option<$crate::tracer::Passage<D>> {
            self.tracer.passage(d, path, surface)
        }
    };
    (@ on_hit) => {
        #[inline(always)]
        fn on_hit<B: Bsdf<D>, L: LightKinds<D> + ?Sized>(
            &self,
            d: D,
            path: &Path<D>,
            vertex: &Vertex<'_, D, B>,
            lights: &L,
        ) -> Option<Color<D::F>> {
            self.tracer.on_hit(d, path, vertex, lights)
        }
    };
    (@ on_miss) => {
        #[inline(always)]
        fn on_miss<L: LightKinds<D> + ?Sized>(
            &self,
            d: D,
            path: &Path<D>,
            lights: &L,
        ) -> Option<Color<D::F>> {
            self.tracer.on_miss(d, path, lights)
        }
    };
    (@ goes_on) => {
        #[inline(always)]
        fn goes_on(&self, d: D, path: &Path<D>) -> D::M {
            self.tracer.goes_on(d, path)
        }
    };
    (@ on_shadow) => {
        #[inline(always)]
        fn on_shadow<B: Bsdf<D>, L: LightKinds<D> + ?Sized>(
            &self,
            d: D,
            path: &Path<D>,
            vertex: &Vertex<'_, D, B>,
            lights: &L,
        ) -> Option<Shadow<D>> {
            self.tracer.on_shadow(d, path, vertex, lights)
        }
    };
    (@ on_bounce) => {
        #[inline(always)]
        fn on_bounce<B: Bsdf<D>>(
            &self,
            d: D,
            path: &Path<D>,
            vertex: &Vertex<'_, D, B>,
        ) -> Option<Bounce<D>> {
            self.tracer.on_bounce(d, path, vertex)
        }
    };
    (@ cost_map) => {
        #[inline(always)]
        fn cost_map(&self) -> Option<CostMap> {
            self.tracer.cost_map()
        }
    };
    (@ layers) => {
        #[inline(always)]
        fn layers(&self) -> Layers {
            self.tracer.layers()
        }
    };
}

pub(super) use forward;
