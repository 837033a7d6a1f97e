//! The functions that kernels call, run on the processor: statement by statement, as they are printed, with every read of a
//! scene's buffers looked at.
//!
//! Printed functions read more than formulas do on the processor: an expression is computed in the innermost block around all
//! its uses, also where none of them is reached, and nothing is left out because a mask holds nowhere. So what is looked at is
//! the recording itself.

use std::cell::{Cell, RefCell};

use residual_bvh::{Hit, Ray};
use residual_device_cpu::{AnyBvh, Traversal};
use residual_render::domain::tape::{Function, Id, Node, ParameterKind, Statement};
use residual_render::domain::{Buffer, Buffers, Scalar, Uint};
use residual_render::film::{Film, Splats, TILE_SIZE};
use residual_render::layer::Layers;
use residual_render::tracer::{MAX_DEPTH, TracerOptions};
use residual_wgsl::{Recorded, SceneFunctions};

/// How often each buffer was read, and where beyond its end.
#[derive(Default)]
pub(crate) struct Reads {
    all: [Cell<u64>; Buffer::COUNT],
    beyond: RefCell<Vec<String>>,
}

impl Reads {
    /// Reads of a buffer, also those beyond its end.
    pub(crate) fn of(&self, buffer: Buffer) -> u64 {
        self.all[buffer as usize].get()
    }

    /// The reads beyond the end of a buffer, in words.
    pub(crate) fn beyond(self) -> Vec<String> {
        self.beyond.into_inner()
    }

    fn word(&self, function: &Function, buffers: &Buffers<'_>, buffer: Buffer, index: u32) -> u32 {
        let all = &self.all[buffer as usize];
        all.set(all.get() + 1);
        let words = buffers.get(buffer);
        words.get(index as usize).copied().unwrap_or_else(|| {
            self.beyond.borrow_mut().push(format!(
                "{}: word {index} of {} in {buffer:?}",
                function.name,
                words.len()
            ));
            0
        })
    }
}

/// A run of a function.
struct Run<'a> {
    function: &'a Function,
    buffers: &'a Buffers<'a>,
    reads: &'a Reads,
    /// Components of the parameters, and where those of each begin.
    arguments: Vec<u32>,
    starts: Vec<usize>,
    values: Vec<u32>,
}

impl Run<'_> {
    fn value(&self, id: Id) -> u32 {
        match self.function.node(id) {
            Node::Constant { bits, .. } => bits,
            Node::Parameter {
                parameter,
                component,
            } => {
                self.arguments
                    [self.starts[parameter as usize] + usize::from(component.unwrap_or(0))]
            }
            Node::Apply { .. }
            | Node::Load { .. }
            | Node::Opaque(_)
            | Node::Branch(_)
            | Node::Choice { .. } => self.values[id.index()],
        }
    }

    fn block(&mut self, statements: &[Statement]) {
        let d = Scalar::new(&Buffers::EMPTY);
        for statement in statements {
            match statement {
                Statement::Let(id) => {
                    self.values[id.index()] = match self.function.node(*id) {
                        Node::Apply { op, operands } => {
                            op.apply(d, operands.map(|id| Uint(self.value(id)))).0
                        }
                        Node::Load { buffer, index } => {
                            let index = self.value(index);
                            self.reads.word(self.function, self.buffers, buffer, index)
                        }
                        Node::Opaque(of) => self.value(of),
                        node @ (Node::Constant { .. }
                        | Node::Parameter { .. }
                        | Node::Branch(_)
                        | Node::Choice { .. }) => panic!("{node:?} is no statement"),
                    };
                }
                Statement::If {
                    mask,
                    choices,
                    then,
                    otherwise,
                } => {
                    let holds = self.value(*mask) != 0;
                    self.block(if holds { then } else { otherwise });
                    for choice in choices {
                        let of_side = if holds { choice.then } else { choice.otherwise };
                        self.values[choice.id.index()] = self.value(of_side);
                    }
                }
            }
        }
    }
}

/// What a function has returned.
struct Returned<'a> {
    function: &'a Function,
    values: Vec<Vec<u32>>,
}

impl Returned<'_> {
    fn words(&self, name: &str) -> Option<&[u32]> {
        let mut names = self.function.outputs.iter();
        let place = names.position(|output| output.name == name)?;
        Some(&self.values[place])
    }

    fn word(&self, name: &str) -> u32 {
        self.words(name).expect("an output")[0]
    }

    fn vector(&self, name: &str) -> [u32; 3] {
        let words = self.words(name).expect("an output");
        words.try_into().expect("a vector")
    }

    /// Whether something is there and active.
    fn has(&self, active: &str) -> bool {
        self.words(active).is_some_and(|words| words[0] != 0)
    }
}

/// A path, in bits.
struct Path {
    org: [u32; 3],
    dir: [u32; 3],
    throughput: [u32; 3],
    pdf: u32,
    rivals: u32,
    pixel: u32,
    index: u32,
    state: u32,
}

fn ray(org: [u32; 3], dir: [u32; 3], tmax: f32) -> Ray {
    let [org, dir] = [org, dir].map(|bits| bits.map(f32::from_bits));
    Ray {
        org,
        tmin: 0.0,
        dir,
        tmax,
    }
}

/// A scene whose functions are recorded.
pub(crate) struct Recording<'a> {
    pub(crate) functions: &'a SceneFunctions,
    /// Of paths from lights, where a sample also has one of them.
    pub(crate) of_lights: Option<&'a SceneFunctions>,
    pub(crate) layers: Layers,
    pub(crate) buffers: Buffers<'a>,
    pub(crate) traversal: &'a AnyBvh,
    pub(crate) options: TracerOptions,
    pub(crate) reads: &'a Reads,
}

impl Recording<'_> {
    fn call<'f>(
        &self,
        recorded: &'f Recorded,
        argument: impl Fn(&str) -> [u32; 3],
    ) -> Returned<'f> {
        let function = &recorded.function;
        let (mut arguments, mut starts) = (Vec::new(), Vec::new());
        for parameter in &function.parameters {
            starts.push(arguments.len());
            let components = match parameter.kind {
                ParameterKind::Real | ParameterKind::Word | ParameterKind::Truth => 1,
                ParameterKind::Vector => 3,
            };
            arguments.extend(&argument(parameter.name)[..components]);
        }
        let mut run = Run {
            function,
            buffers: &self.buffers,
            reads: self.reads,
            arguments,
            starts,
            values: vec![0; function.nodes()],
        };
        run.block(&function.body);
        let outputs = function.outputs.iter();
        let values = outputs.map(|output| output.values.iter().map(|&id| run.value(id)).collect());
        Returned {
            function,
            values: values.collect(),
        }
    }

    fn emit(&self, functions: &SceneFunctions, [x, y]: [u32; 2], sample: u32) -> Path {
        let [width, height] = self.options.image.map(|pixels| (pixels as f32).to_bits());
        let start = self.call(&functions.emit, |name| match name {
            "x" => [x; 3],
            "y" => [y; 3],
            "sample" => [sample; 3],
            "width" => [width; 3],
            "height" => [height; 3],
            "seed" => [self.options.seed; 3],
            other => unreachable!("{other}"),
        });
        Path {
            org: start.vector("org"),
            dir: start.vector("dir"),
            throughput: match start.words("throughput") {
                Some(_) => start.vector("throughput"),
                None => [1.0_f32.to_bits(); 3],
            },
            pdf: start.words("pdf").map_or(0, |pdf| pdf[0]),
            rivals: start.words("rivals").map_or(0, |rivals| rivals[0]),
            pixel: start.word("pixel"),
            index: start.words("index").map_or(sample, |index| index[0]),
            state: start.words("state").map_or(1, |state| state[0]),
        }
    }

    fn program_of(&self, prim: u32) -> usize {
        let program = self.call(&self.functions.program_of, |_| [prim; 3]);
        program.word("program") as usize
    }

    fn is_there(&self, ray: &Ray, hit: &Hit) -> bool {
        let program = &self.functions.programs[self.program_of(hit.prim)];
        program.alpha_test.as_ref().is_none_or(|test| {
            let test = self.call(test, |name| match name {
                "prim" => [hit.prim; 3],
                "u" => [hit.u.to_bits(); 3],
                "v" => [hit.v.to_bits(); 3],
                "org" => ray.org.map(f32::to_bits),
                "dir" => ray.dir.map(f32::to_bits),
                other => unreachable!("{other}"),
            });
            test.word("passes") != 0
        })
    }

    fn step<'f>(&self, step: &'f Recorded, path: &Path, hit: &Hit) -> Returned<'f> {
        self.call(step, |name| match name {
            "prim" => [hit.prim; 3],
            "u" => [hit.u.to_bits(); 3],
            "v" => [hit.v.to_bits(); 3],
            "org" => path.org,
            "dir" => path.dir,
            "throughput" => path.throughput,
            "pdf" => [path.pdf; 3],
            "rivals" => [path.rivals; 3],
            "pixel" => [path.pixel; 3],
            "index" => [path.index; 3],
            "state" => [path.state; 3],
            "max_depth" => [self.options.max_depth; 3],
            "roulette_from" => [self.options.roulette_from; 3],
            "reach" => [self.options.reach.to_bits(); 3],
            "width" => [(self.options.image[0] as f32).to_bits(); 3],
            "height" => [(self.options.image[1] as f32).to_bits(); 3],
            other => unreachable!("{other}"),
        })
    }

    /// A sample of a pixel: radiance and layers.
    fn sample(&self, pixel: [u32; 2], sample: u32) -> Vec<f32> {
        let mut numbers = vec![0.0_f32; self.layers.stride()];
        let add = |numbers: &mut [f32], color: &[u32]| {
            for (number, &bits) in numbers.iter_mut().zip(color) {
                *number += f32::from_bits(bits);
            }
        };
        self.follow(self.functions, pixel, sample, |path, step, is_lit| {
            if let Some(seen) = step.words("seen") {
                add(&mut numbers, seen);
            }
            if path.state & MAX_DEPTH == 1 {
                for layer in self.layers.of_samples() {
                    let value = step.words(layer.name()).expect("a layer");
                    let numbers = numbers[self.layers.offset(layer)..].iter_mut();
                    for (number, &bits) in numbers.zip(value) {
                        *number = f32::from_bits(bits);
                    }
                }
            }
            if is_lit {
                add(&mut numbers, &step.vector("shadow_contribution"));
            }
        });
        numbers
    }

    /// The splats of the light path with the number of a pixel: in its first sample.
    fn splats(&self, functions: &SceneFunctions, pixel: [u32; 2], sample: u32) -> Vec<f32> {
        let mut list = Vec::new();
        self.follow(functions, pixel, sample, |_, step, is_lit| {
            if is_lit {
                list.extend(step.vector("shadow_contribution").map(f32::from_bits));
                list.push(f32::from_bits(step.word("shadow_pixel")));
            }
        });
        list
    }

    /// Follows a path. `at` each vertex it is said what became of it, and whether its shadow ray arrived.
    fn follow(
        &self,
        functions: &SceneFunctions,
        pixel: [u32; 2],
        sample: u32,
        mut at: impl FnMut(&Path, &Returned<'_>, bool),
    ) {
        let mut path = self.emit(functions, pixel, sample);
        let alpha = |ray: &Ray, hit: &Hit| self.is_there(ray, hit);
        let mut programs = functions.programs.iter();
        let has_alpha = programs.any(|program| program.alpha_test.is_some());
        let alpha = has_alpha.then_some(&alpha as &dyn Fn(&Ray, &Hit) -> bool);
        for _ in 0..self.options.max_depth {
            let mut hit = [Hit::miss(f32::MAX)];
            let rays = [ray(path.org, path.dir, f32::MAX)];
            self.traversal.closest_hits(&rays, &mut hit, alpha);
            let [hit] = hit;
            let step = match hit.is_hit() {
                true => functions.programs[self.program_of(hit.prim)].step.as_ref(),
                false => functions.miss.as_ref(),
            };
            let Some(step) = step else {
                break;
            };
            let step = self.step(step, &path, &hit);
            let mut is_lit = false;
            if step.has("shadow_active") {
                let tmax = f32::from_bits(step.word("shadow_tmax"));
                let rays = [ray(
                    step.vector("shadow_org"),
                    step.vector("shadow_dir"),
                    tmax,
                )];
                let mut occluded = [false];
                self.traversal.any_hits(&rays, &mut occluded, alpha);
                is_lit = !occluded[0];
            }
            at(&path, &step, is_lit);
            if !step.has("bounce_active") {
                break;
            }
            path = Path {
                org: step.vector("bounce_org"),
                dir: step.vector("bounce_dir"),
                throughput: step.vector("bounce_throughput"),
                pdf: step.word("bounce_pdf"),
                rivals: step.words("bounce_rivals").map_or(0, |rivals| rivals[0]),
                state: step.word("bounce_state"),
                ..path
            };
        }
    }

    /// An image no larger than a tile.
    pub(crate) fn film(&self, samples: u32) -> Film {
        let [width, height] = self.options.image;
        assert!(width.max(height) <= TILE_SIZE);
        let mut film = Film::new(width, height, TILE_SIZE, self.layers);
        for sample in 0..samples {
            let pixels = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
            let mut numbers: Vec<f32> = pixels
                .clone()
                .flat_map(|pixel| self.sample(pixel, sample))
                .collect();
            if let Some(functions) = self.of_lights {
                let mut splats = Splats::new(self.options.image, 1);
                for pixel in pixels {
                    splats.add(&self.splats(functions, pixel, sample));
                }
                let rect = film.tiles()[0].rect();
                splats.add_to(rect, 0, self.layers.stride(), &mut numbers);
            }
            film.tiles_mut()[0].add(&numbers);
        }
        film
    }
}
