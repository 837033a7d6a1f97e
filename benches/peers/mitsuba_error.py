"""Mitsuba 3 as a peer of `cargo xtask bench error`.

    python3 mitsuba_error.py FOLDER THREADS [VARIANT]

FOLDER has scene.xml and sensor.xml, as residual-benches exports them, with the BSDF of mitsuba_coat.py; 0 threads are one for each processor. The first line of
standard output says who renders:

    {"renderer": "Mitsuba", "version": "3.9.1", "variant": "llvm_ad_rgb", "samplers": ["independent", ...], "notes": [...]}

or, with status 1, {"missing": "why there is no renderer"}. Then each line of standard input asks for an image,

    {"sampler": "independent", "samples": 64, "seed": 3, "image": "/tmp/image.f32"}

which is written to that file (32-bit floats, red, green, blue, row by row from the top), and is answered by

    {"samples": 64, "cpu_s": 1.25}

or {"error": "..."}. `samples` may be more than were asked for, where a sampler wants a square or a power of two. `cpu_s` is CPU
time of all threads, without reading the scene, building its hierarchy and compiling kernels: a first image with the same sampler
and number of samples, which is not timed, has them compiled. Tracing the kernel anew for each image, 2 ms, is in it.
"""

import glob
import json
import os
import subprocess
import sys
import time

SAMPLERS = ["independent", "multijitter", "ldsampler"]
VARIANTS = ["llvm_ad_rgb", "scalar_rgb"]
# Far from those that are asked for.
WARMING_SEED = 0x5EED0000


def answer(value):
    print(json.dumps(value), flush=True)


def find_llvm():
    """Has Dr.Jit use rustc's LLVM, unless the user names another: those of distributions may be too old, and end the process."""
    if "DRJIT_LIBLLVM_PATH" in os.environ:
        return
    try:
        rustc = subprocess.run(["rustc", "--print", "sysroot"], capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        return
    found = sorted(glob.glob(os.path.join(rustc.stdout.strip(), "lib", "libLLVM*.so.*")))
    if found:
        os.environ["DRJIT_LIBLLVM_PATH"] = found[0]


def choose(mitsuba, wanted):
    """Sets the first variant that works. Returns its name, more about it, and why others do not work."""
    problems = []
    for variant in [wanted] if wanted else VARIANTS:
        try:
            mitsuba.set_variant(variant)
            about = variant
            if variant.startswith("llvm"):
                import drjit

                # Without LLVM's library it is the first array that fails.
                drjit.eval(mitsuba.Float([0.0]) + 1)
                about += ", LLVM " + ".".join(map(str, drjit.detail.llvm_version()))
            return variant, about, problems
        except Exception as problem:
            problems.append(f"{variant}: {first_line(problem)}")
    return None, None, problems


def first_line(problem):
    return (str(problem).strip() or repr(problem)).splitlines()[0]


class Renderer:
    def __init__(self, mitsuba, drjit, folder, variant):
        self.mitsuba = mitsuba
        self.drjit = drjit
        self.folder = folder
        self.is_jit = not variant.startswith("scalar")
        self.scene = mitsuba.load_file(os.path.join(folder, "scene.xml"), parallel=False)
        self.sensors = {}
        self.warm = set()

    def sensor(self, sampler):
        if sampler not in self.sensors:
            path = os.path.join(self.folder, "sensor.xml")
            self.sensors[sampler] = self.mitsuba.load_file(path, sampler=sampler)
        return self.sensors[sampler]

    def timed(self, sampler, samples, seed):
        """An image, and the CPU seconds that it took."""
        sensor = self.sensor(sampler)
        start = time.process_time()
        image = self.mitsuba.render(self.scene, sensor=sensor, spp=samples, seed=seed)
        if self.is_jit:
            self.drjit.eval(image)
            self.drjit.sync_thread()
        return image, time.process_time() - start

    def render(self, request):
        import numpy

        sampler, samples = request["sampler"], request["samples"]
        # Kernels of some samplers have the number of samples in them.
        if (sampler, samples) not in self.warm:
            self.timed(sampler, samples, WARMING_SEED)
            self.warm.add((sampler, samples))
        image, cpu_s = self.timed(sampler, samples, request["seed"])
        numpy.array(image, dtype="<f4")[:, :, :3].tofile(request["image"])
        taken = self.sensor(sampler).sampler().sample_count()
        return {"samples": taken, "cpu_s": cpu_s}


def main():
    folder, threads = sys.argv[1], int(sys.argv[2])
    find_llvm()
    try:
        import drjit
        import mitsuba
        import numpy
    except ImportError as problem:
        answer({"missing": f"{first_line(problem)} (pip install mitsuba numpy)"})
        return 1
    variant, about, problems = choose(mitsuba, sys.argv[3] if len(sys.argv) > 3 else None)
    if variant is None:
        answer({"missing": "; ".join(problems)})
        return 1
    mitsuba.set_log_level(mitsuba.LogLevel.Error)
    import mitsuba_coat

    mitsuba_coat.register()
    # A thread that reads an EXR file waits for others: one alone waits for ever.
    drjit.set_thread_count(2)
    renderer = Renderer(mitsuba, drjit, folder, variant)
    drjit.set_thread_count(threads or os.cpu_count())
    answer(
        {
            "renderer": "Mitsuba",
            "version": mitsuba.__version__,
            "variant": about,
            "samplers": SAMPLERS,
            "notes": problems,
        }
    )
    for line in sys.stdin:
        try:
            answer(renderer.render(json.loads(line)))
        except Exception as problem:
            answer({"error": first_line(problem)})
    return 0


if __name__ == "__main__":
    sys.exit(main())
