#pragma once
// The methods and their options: one plain struct for each, with the library's defaults.
//
// Names on the command line, in JSON and in Python are those of the members with hyphens for
// underscores; docs/reference/support.md lists all of them with ranges and units. Values out of
// range are an InputError where a method is prepared.

#include <string>

namespace littoral {

// ---------------------------------------------------------------------------- on surfaces

/// How broken signed curves become whole: by the shortest curves that make them bound, by the zero
/// set of the signed heat method, not at all; automatic: not where they bound, by the zero set
/// where they have ends, by the shortest curves where pieces are reversed and nothing is missing.
enum class Completion { automatic, shortest, heat, none };

/// What measures how far: exact polyhedral distance, fast marching, or the signed heat method
/// itself; automatic: the most accurate that the surface allows.
enum class Metric { automatic, exact, fast_marching, heat };

/// The default: signed curves are completed where they are broken, and distance is measured from
/// both. Exact on triangle meshes where curves bound, for unsigned curves and for points; on large
/// ones to `tolerance`.
struct Automatic {
  static constexpr const char* method = "auto";
  Completion completion = Completion::automatic;
  Metric metric = Metric::automatic;
  bool confidence = false;  // how sure each sign is, 0 to 1, beside the distance
  double tolerance = 1e-5;  // share of every distance that it may be off by on more than 100,000
                            // triangles; 0: exact
};

/// How values at the source are held (signed heat method, section 7.1).
enum class Constraint { none, zero_set, level_sets };

/// Afterwards unit gradient almost everywhere and the same signs: on linear elements (section 7.3),
/// or with the zero set as the source of quadratic-order geodesics.
enum class Sharpening { off, on, quadratic };

/// How sharpening is solved: alternating directions on one factorization, or the primal-dual
/// hybrid gradient method, which only multiplies.
enum class SharpenSolver { admm, pdhg };

/// Where the diffused vectors come from where all sources are points.
enum class PointVectors { gradient, radial };

/// Signed distance to curves that may be broken, unsigned to points and unsigned curves.
/// Feng, Crane: A Heat Method for Generalized Signed Distance (2024).
struct SignedHeat {
  static constexpr const char* method = "signed-heat";
  double time_scale = 0;  // t = time_scale h^2, h half the mean edge length; 0: automatic
  Constraint constraint = Constraint::zero_set;
  double soft = 0;  // > 0: penalty instead of the constraint, per mean edge length of source
  bool preserve_normals = false;  // diffused vectors equal the normals at the source itself
  PointVectors point_sources = PointVectors::gradient;
  bool intrinsic_delaunay = false;  // on better triangles of the same surface
  bool discontinuous = false;       // integrate with the least jumps (section 7.2) instead of none
  double jump_threshold = 1;        // jumps above that many mean edge lengths stay ...
  double smoothing = 1;  // ... others close by heat flow for that many squared ones; 0: all stay
  Sharpening sharpen = Sharpening::off;
  SharpenSolver sharpen_solver = SharpenSolver::admm;
  bool bounding_only = false;  // leave out parts of curves that bound nothing
};

/// Unsigned distance to curves and points.
/// Crane, Weischedel, Wardetzky: Geodesics in Heat (2013).
struct UnsignedHeat {
  static constexpr const char* method = "unsigned-heat";
  double time_scale = 0;            // t = time_scale h^2, h the mean edge length; 0: automatic
  bool intrinsic_delaunay = false;  // on better triangles of the same surface
};

/// Exact unsigned distance along the polyhedral surface.
/// Mitchell, Mount, Papadimitriou: The Discrete Geodesic Problem (1987).
struct Exact {
  static constexpr const char* method = "exact";
  double tolerance = 0;  // share of every distance that it may be off by; more is faster
};

/// First-order distance to points and unbroken curves, signed or not.
/// Kimmel, Sethian: Computing Geodesic Paths on Manifolds (1998).
struct FastMarching {
  static constexpr const char* method = "fast-marching";
};

/// Distance of quadratic order to points anywhere and curves.
/// Ruan, Chern, Li, Subr, Vaxman: Quadratic-Order Geodesics on Meshes.
struct Quadratic {
  static constexpr const char* method = "quadratic";
  double tolerance = 1e-5;      // of the duality gap, relative to the integral of u
  int max_iterations = 100;     // of the interior-point method, for each component
  double source_radius = 1e-4;  // d at a source may be this many mean edge lengths
  double spacing = 0;           // of samples on curves, in mean edge lengths; 0: none, distances
  bool insert_samples = true;   // hold u >= |grad u|^2 / 4 between the seven points too
  bool is_signed = false;       // sign and zero set from the signed heat method
  int subdivide = 1;            // parts of each side in the mesh written for viewing
};

/// What smoothness means (F of eq. 2).
enum class Regularizer { dirichlet, hessian, align, max_norm };

/// What functions are between the nodes (supplement 10.5).
enum class Elements { linear, quadratic };

/// On which triangles of the same surface functions are linear: these, intrinsic Delaunay ones with
/// the same vertices, or the latter where more than a few edges are not Delaunay.
enum class Triangles { automatic, as_is, delaunay };

/// Unsigned distance that is smooth at the cut locus, aligned to directions, or unaffected by
/// boundaries. Edelstein, Guillen, Solomon, Ben-Chen: A Convex Optimization Framework for
/// Regularized Geodesic Distances (2023).
struct Regularized {
  static constexpr const char* method = "regularized";
  double alpha = 0.05;  // alpha-hat (7.1); 0: the distance of Belyaev and Fayolle (eq. 1)
  Regularizer regularizer = Regularizer::dirichlet;
  double beta = 100;        // beta-hat: weight of alignment against smoothness (eq. 8)
  std::string field{};      // file of directions for align
  double field_width = 0;   // > 0: of the Gaussian that localises interpolated directions, times
                            // the square root of the area
  double tolerance = 2e-3;  // eps^rel of supplement 8
  double gap = 0;           // > 0: iterate until the relative duality gap is below
  int max_iterations = 10000;
  Elements elements = Elements::linear;
  Triangles triangulation = Triangles::automatic;
  int subdivide = 1;  // cuts of a triangle's sides where the field is shown
};

/// Unsigned distance as the largest function of gradient at most 1.
/// Belyaev, Fayolle: An ADMM-based scheme for distance function approximation (2020).
struct BelyaevFayolle {
  static constexpr const char* method = "belyaev-fayolle";
  double tolerance = 2e-3;
  double gap = 0;
  int max_iterations = 10000;
  Elements elements = Elements::linear;
  Triangles triangulation = Triangles::automatic;
  int subdivide = 1;
};

// ---------------------------------------------------------------------------- all pairs

/// How the matrices of the iteration are kept. The arithmetic is in double precision.
enum class Storage { automatic, full, single };

/// Distance between all pairs of vertices at once, smooth and the same in both directions.
/// Edelstein et al. (2023), section 6.
struct Symmetric {
  static constexpr const char* method = "symmetric";
  double alpha = 0.05;      // alpha-hat (7.1)
  double tolerance = 1e-3;  // of all residuals
  int max_iterations = 3000;
  Storage storage = Storage::automatic;  // single precision above half of the memory
};

// ---------------------------------------------------------------------------- regions

/// How faces get their labels.
enum class Labels { round, cut };

/// Values at corners of a mesh cut along the curve; one per face; or continuous (thesis 6.4).
enum class Formulation { primal, dual, nonconforming };

/// What the residual function is a choice of: one constant per face, or per part of the surface
/// between curves completed by shortest paths (thesis 6.3).
enum class Residual { faces, paths };

/// What happens at the boundary of the surface (thesis 6.2): nothing flows across it, or, nearly,
/// what would happen without it.
enum class BoundaryCondition { natural, free };

/// Which value of a winding number function, a real number near curves with gaps, is halfway
/// between two integers (thesis 7.1).
enum class Contour {
  curve,     // its circular mean along the curve
  frequent,  // the most frequent one along the curve, to a tenth
  mean,      // its plain mean along the curve
};

/// Regions that (broken) signed curves bound on a surface, and curves that bound nothing.
/// Feng, Gillespie, Crane: Winding Numbers on Discrete Surfaces (2023).
struct SurfaceWinding {
  static constexpr const char* method = "surface-winding";
  Formulation formulation = Formulation::primal;
  BoundaryCondition boundary_condition = BoundaryCondition::natural;
  Residual residual = Residual::faces;
  Contour contour = Contour::curve;
  Labels labels = Labels::round;
  double curve_weight = 0.01;       // cost of a unit jump on the curve, relative to elsewhere
  bool keep_nonbounding = false;    // label by rounding u, without decomposing the curve
  bool intrinsic_delaunay = false;  // flip edges beside the curve before solving
};

// ---------------------------------------------------------------------------- through tets

/// The default: straight lines to the nearest point of the source, negative behind a surface, and
/// ways round the boundary where these leave the tets. Surfaces that leave sides open are completed
/// by the zero set of the signed heat method.
struct TetAutomatic {
  static constexpr const char* method = "auto";
};

/// Distance of quadratic order from vertices, or from a surface without sign.
/// Ruan, Chern, Li, Subr, Vaxman: Quadratic-Order Geodesics on Meshes.
struct TetQuadratic {
  static constexpr const char* method = "quadratic";
  double tolerance = 1e-5;      // of the duality gap, relative to the integral of u
  int max_iterations = 100;     // of the interior-point method, for each component
  double source_radius = 1e-4;  // d at a source may be this many mean edge lengths
  bool insert_samples = true;   // hold u >= |grad u|^2 / 4 between the samples too
};

// ---------------------------------------------------------------------------- in space

/// The default: an input is completed where it has holes, then distance is measured to it and to
/// what completes it, negative inside. Exact around closed surfaces. Surfaces are completed where
/// their winding number is half way, clouds by the zero set of the tori that fit them.
/// After Barill et al.: Fast Winding Numbers for Soups and Clouds (2018), and Feng (2026).
struct SpaceAutomatic {
  static constexpr const char* method = "auto";
};

/// How values at the source are held in space: not, at zero, pulled towards zero, or at one value
/// for each connected part of a surface (clouds are one part). Automatic: zero through tets that
/// are given or follow the input, where no weight is given; otherwise pulled.
enum class SpaceConstraint { automatic, none, zero_set, soft, level_sets };

/// Signed distance around surfaces that may be broken, on grids and through tets.
/// Feng, Crane: A Heat Method for Generalized Signed Distance (2024), section 8.2.
struct SpaceSignedHeat {
  static constexpr const char* method = "signed-heat";
  double time_scale = 1;  // t = time_scale h^2, h the mean distance between samples of the input
  SpaceConstraint constraint = SpaceConstraint::automatic;
  double soft = 0;       // weight of the penalty; 0: 10
  bool sharpen = false;  // afterwards as large as a unit gradient allows (7.3)
};

/// Distance to the nearest point, negative where the winding number exceeds 1/2.
/// Barill et al.: Fast Winding Numbers for Soups and Clouds (2018).
struct WindingSign {
  static constexpr const char* method = "winding";
};

/// Distance to the nearest point, signed by the pseudonormal there; exact on closed meshes.
/// Baerentzen, Aanaes: Signed Distance Computation Using the Angle Weighted Pseudonormal (2005).
struct ClosestPoint {
  static constexpr const char* method = "closest-point";
};

/// Logarithm of the screened winding number. Feng: Generalized Distance and Winding (2026), 5.8.
struct HopfCole {
  static constexpr const char* method = "hopf-cole";
  double sharpness = 2;  // decay lambda of the kernel times the mean distance between samples
};

/// Weighted mean of the distances to the samples' planes. Feng (2026), eq. 5.9.
struct Planar {
  static constexpr const char* method = "planar";
  double sharpness = 2;
};

/// Smooth minimum of the distances to the samples, signed by the winding number.
/// Madan, Levin: Fast Evaluation of Smooth Distance Constraints (2022).
struct LogSumExp {
  static constexpr const char* method = "log-sum-exp";
  double sharpness = 2;
};

/// Which weights the neighbours have that a torus is fitted to.
enum class TorusWeights { closed, learned };

/// Blend of the tori that fit the surface around each point best. Feng (2026), chapter 5.
struct Tori {
  static constexpr const char* method = "tori";
  bool noisy = false;  // more neighbours; tori need not pass through their points
  TorusWeights fit = TorusWeights::closed;
  std::string weights{};       // file of weights of the network, instead of the library's
  bool drop_outliers = false;  // leave out points that hardly any neighbour agrees with
  bool single = false;         // sum in single precision
};

/// Distance that is smooth at the medial axis, signed by the winding number; small grids.
struct SpaceRegularized {
  static constexpr const char* method = "regularized";
  double alpha = 0.05;
  double tolerance = 2e-3;
  double gap = 0;
  int max_iterations = 10000;
};

/// The same without smoothing: the largest function of gradient at most 1.
struct SpaceBelyaevFayolle {
  static constexpr const char* method = "belyaev-fayolle";
  double tolerance = 2e-3;
  double gap = 0;
  int max_iterations = 10000;
};

}  // namespace littoral
