"""Files of layerloop open in the programs that users own: h5py, and the reader that ParaView 5.11 uses for .h5 (VTK 9.1).
And files that another program wrote, or tampered with, are refused in words.

Usage: open_elsewhere.py SAMPLE_FILES_PROGRAM
"""
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOHDF import vtkHDFReader

PROGRAM = sys.argv.pop(1)


def read_with_vtk(path):
    reader = vtkHDFReader()
    assert reader.CanReadFile(str(path))
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutputDataObject(0)


class OpenElsewhere(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.bed = Path(cls.folder.name) / "bed_0001.h5"
        cls.heat = Path(cls.folder.name) / "heat_0001.h5"
        subprocess.run([PROGRAM, cls.folder.name], check=True)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_bed_in_h5py(self):
        with h5py.File(self.bed) as file:
            self.assertEqual(file.attrs["format_version"], 2)
            self.assertEqual(file["bed/position"].attrs["unit"], b"m")
            np.testing.assert_array_equal(file["bed/id"], np.arange(5, 15))
            np.testing.assert_array_equal(file["bed/position"][:, 1], 2e-5 * np.arange(10))
            np.testing.assert_array_equal(file["bed/contact_keys"], [[5, 6]])
            self.assertEqual(file["substrate/triangles"].shape, (2, 3))

    def test_every_own_dataset_with_a_dimension_names_its_unit(self):
        bare = {"id", "material", "contact_keys", "triangles", "layer", "cells"}
        for path in (self.bed, self.heat):
            with h5py.File(path) as file:
                for group in set(file) - {"VTKHDF"}:
                    for name, dataset in file[group].items():
                        self.assertTrue(name in bare or "unit" in dataset.attrs, f"{path.name}:{group}/{name}")

    def test_bed_in_vtk(self):
        grid = read_with_vtk(self.bed)
        self.assertEqual(grid.GetClassName(), "vtkUnstructuredGrid")
        self.assertEqual((grid.GetNumberOfPoints(), grid.GetNumberOfCells()), (14, 12))
        self.assertEqual([grid.GetCellType(c) for c in (0, 9, 10, 11)], [1, 1, 5, 5])
        self.assertEqual([grid.GetCell(11).GetPointId(c) for c in range(3)], [11, 13, 12])
        radius = vtk_to_numpy(grid.GetPointData().GetArray("radius"))
        np.testing.assert_array_equal(radius, np.append(1e-6 * np.arange(1, 11), np.zeros(4)))
        np.testing.assert_allclose(grid.GetPoint(13), (1e-4, 2e-4, 0), atol=0)

    def test_grid_in_vtk(self):
        image = read_with_vtk(self.heat)
        self.assertEqual(image.GetClassName(), "vtkImageData")
        self.assertEqual(image.GetDimensions(), (4, 3, 2))
        np.testing.assert_allclose(image.GetOrigin(), (1.025e-4, 2.5e-6, -1.75e-5), rtol=1e-12)
        np.testing.assert_allclose(image.GetSpacing(), (5e-6, 5e-6, 5e-6), rtol=0)
        temperature = vtk_to_numpy(image.GetPointData().GetArray("peak_temperature"))
        np.testing.assert_array_equal(temperature, 300.0 + np.arange(24))

    def test_grid_in_h5py(self):
        with h5py.File(self.heat) as file:
            field = file["VTKHDF/PointData/peak_temperature"]
            self.assertEqual((field.shape, field.attrs["unit"]), ((2, 3, 4), b"K"))
            np.testing.assert_array_equal(file["grid/cells"], [4, 3, 2])

    def refusal(self, change):
        """What our reader says of a copy of the bed file after change(file)."""
        copy = Path(self.folder.name) / "changed.h5"
        shutil.copy(self.bed, copy)
        with h5py.File(copy, "r+") as file:
            change(file)
        told = subprocess.run([PROGRAM, "read", copy], capture_output=True, text=True)
        self.assertEqual(told.returncode, 4, told)
        return told.stdout

    def replace(self, file, name, **how):
        values = file[name][:]
        del file[name]
        file.create_dataset(name, data=values, **how)

    def test_unchanged_copy_is_read(self):
        self.assertEqual(subprocess.run([PROGRAM, "read", self.bed]).returncode, 0)

    def test_other_versions_are_refused(self):
        self.assertIn("format version 3", self.refusal(lambda file: file.attrs.modify("format_version", 3)))
        self.assertIn("not a file of layerloop", self.refusal(lambda file: file.attrs.__delitem__("format_version")))

    def test_foreign_storage_is_refused(self):
        def outside(file):
            del file["bed/radius"]
            file["bed/radius"] = h5py.ExternalLink(str(self.bed), "/bed/radius")

        def kept_in_another_file(file):
            del file["bed/radius"]
            file.create_dataset("bed/radius", (10,), "f8", external=[(str(self.heat), 0, 80)])

        def virtual(file):
            layout = h5py.VirtualLayout((10,), "f8")
            layout[:] = h5py.VirtualSource(str(self.bed), "bed/radius", (10,))
            del file["bed/radius"]
            file.create_virtual_dataset("bed/radius", layout)

        def never_written(file):
            del file["bed/radius"]
            file.create_dataset("bed/radius", (1 << 40,), "f8")

        def one_short(file):
            radii = file["bed/radius"][:9]
            del file["bed/radius"]
            file["bed/radius"] = radii

        self.assertIn("damaged", self.refusal(one_short))
        self.assertIn("another file", self.refusal(outside))
        self.assertIn("another file", self.refusal(kept_in_another_file))
        self.assertIn("not contiguous", self.refusal(virtual))
        self.assertIn("size", self.refusal(never_written))
        self.assertIn("not contiguous", self.refusal(lambda file: self.replace(file, "bed/radius", compression="gzip")))
        self.assertIn("kind of number", self.refusal(lambda file: self.replace(file, "bed/radius", dtype="f4")))


if __name__ == "__main__":
    unittest.main(verbosity=2)
