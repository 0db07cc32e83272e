#pragma once
// One writer per format; each writes a whole file to a stream. What is written was checked before.

#include <ostream>
#include <string>

#include "littoral/domain/polygon_soup.h"

namespace littoral::io {

/// The shortest text that reads back as the same double; "inf", "-inf" and "nan" where it is none.
std::string exact_text(double value);

/// `u`, one value per vertex or nothing, becomes the texture coordinate.
void write_obj(std::ostream& out, const PolygonSoup& soup, const VecX* u);
void write_ply(std::ostream& out, const PolygonSoup& soup);
void write_off(std::ostream& out, const PolygonSoup& soup);
/// Faces must be triangles with coordinates in the range of single precision.
void write_stl(std::ostream& out, const PolygonSoup& soup);
/// VTK's XML polygon data with one scalar per point (appended raw data).
void write_vtp(std::ostream& out, const PolygonSoup& soup, const std::string& field);
/// NumPy's format 1.0, one dimension of float64.
void write_npy(std::ostream& out, const VecX& values);

}  // namespace littoral::io
