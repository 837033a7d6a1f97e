//! Tracers around others, and tracers of several kinds: what they leave to the tracer within.

/// Methods of [`Tracer`](super::Tracer) that call those of the field `tracer`, or, `through` a macro, those of the tracer that it finds
/// in `self`: it is given `self`, mostly `d`, a name for the tracer, and the call.
macro_rules! forward {
    (through $through:ident; $($method:ident),* $(,)?) => {
        $($crate::tracer::forward::forward!(@ [$through] $method);)*
    };
    ($($method:ident),* $(,)?) => {
        $($crate::tracer::forward::forward!(@ [$crate::tracer::forward::to_field] $method);)*
    };
    (@ [$($through:tt)*] on_emit) => {
        #[inline(always)]
        fn on_emit<K: Camera<D>, L: LightKinds<D> + ?Sized>(
            &self,
            d: D,
            camera: &K,
            lights: &L,
            pixel: [D::U; 2],
            sample: D::U,
        ) -> Path<D> {
            $($through)*!(self, d; tracer => tracer.on_emit(d, camera, lights, pixel, sample))
        }
    };
    (@ [$($through:tt)*] path_origin) => {
        #[inline(always)]
        fn path_origin(&self) -> Option<$crate::tracer::PathOrigin> {
            $($through)*!(self; tracer => tracer.path_origin())
        }
    };
    (@ [$($through:tt)*] wavelength) => {
        #[inline(always)]
        fn wavelength(&self, d: D, path: &Path<D>) -> Option<D::F> {
            $($through)*!(self, d; tracer => tracer.wavelength(d, path))
        }
    };
    (@ [$($through:tt)*] cone) => {
        #[inline(always)]
        fn cone(&self, d: D, path: &Path<D>) -> Option<$crate::surface::Cone<D>> {
            $($through)*!(self, d; tracer => tracer.cone(d, path))
        }
    };
    (@ [$($through:tt)*] crossing) => {
        #[inline(always)]
        fn crossing(
            &self,
            d: D,
            path: &Path<D>,
            surface: &Surface<D>,
            interior: D::U,
        ) -> Option<$crate::tracer::Crossing<D>> {
            $($through)*!(self, d; tracer => tracer.crossing(d, path, surface, interior))
        }
    };
    (@ [$($through:tt)*] passage) => {
        #[inline(always)]
        fn passage(
            &self,
            d: D,
            path: &Path<D>,
            surface: &Surface<D>,
        ) -> Option<$crate::tracer::Passage<D>> {
            $($through)*!(self, d; tracer => tracer.passage(d, path, surface))
        }
    };
    (@ [$($through:tt)*] on_hit) => {
        #[inline(always)]
        fn on_hit<B: Bsdf<D>, L: LightKinds<D> + ?Sized>(
            &self,
            d: D,
            path: &Path<D>,
            vertex: &Vertex<'_, D, B>,
            lights: &L,
        ) -> Option<Color<D::F>> {
            $($through)*!(self, d; tracer => tracer.on_hit(d, path, vertex, lights))
        }
    };
    (@ [$($through:tt)*] on_miss) => {
        #[inline(always)]
        fn on_miss<L: LightKinds<D> + ?Sized>(
            &self,
            d: D,
            path: &Path<D>,
            lights: &L,
        ) -> Option<Color<D::F>> {
            $($through)*!(self, d; tracer => tracer.on_miss(d, path, lights))
        }
    };
    (@ [$($through:tt)*] goes_on) => {
        #[inline(always)]
        fn goes_on(&self, d: D, path: &Path<D>) -> D::M {
            $($through)*!(self, d; tracer => tracer.goes_on(d, path))
        }
    };
    (@ [$($through:tt)*] on_shadow) => {
        #[inline(always)]
        fn on_shadow<B: Bsdf<D>, L: LightKinds<D> + ?Sized>(
            &self,
            d: D,
            path: &Path<D>,
            vertex: &Vertex<'_, D, B>,
            lights: &L,
        ) -> Option<Shadow<D>> {
            $($through)*!(self, d; tracer => tracer.on_shadow(d, path, vertex, lights))
        }
    };
    (@ [$($through:tt)*] on_bounce) => {
        #[inline(always)]
        fn on_bounce<B: Bsdf<D>>(
            &self,
            d: D,
            path: &Path<D>,
            vertex: &Vertex<'_, D, B>,
        ) -> Option<Bounce<D>> {
            $($through)*!(self, d; tracer => tracer.on_bounce(d, path, vertex))
        }
    };
    (@ [$($through:tt)*] cost_map) => {
        #[inline(always)]
        fn cost_map(&self) -> Option<CostMap> {
            $($through)*!(self; tracer => tracer.cost_map())
        }
    };
    (@ [$($through:tt)*] layers) => {
        #[inline(always)]
        fn layers(&self) -> Layers {
            $($through)*!(self; tracer => tracer.layers())
        }
    };
}

/// The tracer in the field `tracer`.
macro_rules! to_field {
    ($of:expr $(, $d:ident)?; $tracer:ident => $call:expr) => {{
        let $tracer = &$of.tracer;
        $call
    }};
}

pub(super) use {forward, to_field};
