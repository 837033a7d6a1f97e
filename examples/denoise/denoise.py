"""Denoises an EXR of Residual with Intel Open Image Denoise.

The EXR has the layers that guide the filter: render it with `--aov albedo,normal`. See README.md.
"""

import argparse

import numpy as np
import OpenEXR
import pyoidn


def read(path):
    """The channels of an EXR by their names."""
    with OpenEXR.File(path, separate_channels=True) as file:
        return {name: channel.pixels for name, channel in file.channels().items()}


def stack(channels, names):
    """Three channels as an array of shape (height, width, 3); None where the file lacks one."""
    if any(name not in channels for name in names):
        return None
    return np.stack([channels[name] for name in names], axis=-1).astype(np.float32)


def radiance(channels):
    return stack(channels, ["R", "G", "B"])


def denoise(channels):
    """The denoised radiance of an image, linear as it was."""
    return pyoidn.denoise(
        radiance(channels),
        albedo=stack(channels, ["albedo.R", "albedo.G", "albedo.B"]),
        normal=stack(channels, ["normal.X", "normal.Y", "normal.Z"]),
        hdr=True,
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("image", help="EXR with the layers albedo and normal")
    parser.add_argument("output", help="EXR for the denoised image")
    args = parser.parse_args()

    channels = read(args.image)
    if radiance(channels) is None:
        parser.error(f"{args.image} has no channels R, G, B")
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    with OpenEXR.File(header, {"RGB": denoise(channels)}) as file:
        file.write(args.output)


if __name__ == "__main__":
    main()
