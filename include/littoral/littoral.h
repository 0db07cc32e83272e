#pragma once
// Distance and inside/outside for geometry that is broken: everything in one header.
//
//   surfaces   Mesh, Sources, distance, DistanceSolver, distance_matrix, winding
//   space      Sdf, signed_distance, winding_number, Grid, Volume, isosurface, offset
//   tets       TetMesh, tets_around, TetDistanceSolver
//   matrices   surface_operators, Factorization
//   files      read_mesh, read_soup, read_sources, read_volume, read_tets, write, write_page
//   drawing    triangulation, path_through, offset_curves, parse_sources, sources_text
//   methods    options.h has a struct for each; method_families() lists them
//
// Lengths are in the unit of the input. Every error is a littoral::Error.

#include "littoral/batch.h"
#include "littoral/context.h"
#include "littoral/distance.h"
#include "littoral/drawing.h"
#include "littoral/error.h"
#include "littoral/field.h"
#include "littoral/io.h"
#include "littoral/mesh.h"
#include "littoral/methods.h"
#include "littoral/operators.h"
#include "littoral/options.h"
#include "littoral/repair.h"
#include "littoral/report.h"
#include "littoral/samples.h"
#include "littoral/sources.h"
#include "littoral/space.h"
#include "littoral/through_tets.h"
#include "littoral/volume.h"
#include "littoral/winding.h"
