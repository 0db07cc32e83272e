#include "base/messages.h"

#include <array>

namespace littoral {

namespace {

constexpr auto an_error = Message::Kind::error;
constexpr auto a_warning = Message::Kind::warning;

constexpr std::array message_table = std::to_array<Message>({
    // What was asked for.
    {an_error, "usage", "an argument is missing, comes twice or has no value",
     "the command line could not be understood", "`littoral help VERB`"},
    {an_error, "unknown-name", "there is no verb, option, method, field or word of this name",
     "a misspelt name, or an option of another verb or method",
     "take the nearest name, or one of the list, from the message"},
    {an_error, "option-value", "an option's value is out of range, or not what the option takes",
     "the message names the option, what it takes and what was found",
     "change the value; [options](../reference/support.md) lists ranges and units"},
    {an_error, "options-conflict",
     "an option does not go with this method, file or other option, or needs another",
     "the combination has no meaning, or there is no such algorithm",
     "leave one of the two out, or give the other one that the message names"},
    {an_error, "nothing-given", "nothing to measure from, no curves, no offset, no levels",
     "the verb needs something that was not named", "name it by one of the options in the message"},
    {an_error, "unsupported", "a method does not run on this kind of surface, or not for this",
     "the message says what it runs on",
     "take the method that it names, or cut polygons with `littoral convert --triangulate`"},
    {an_error, "bad-input", "what is given does not fit together",
     "the message names the first element that is wrong", "correct that element"},
    // Files.
    {an_error, "cannot-read", "a file or folder cannot be opened",
     "it is not there, is a folder, or may not be read", "check the path and its permissions"},
    {an_error, "cannot-write", "a result cannot be written",
     "the folder is missing, full or not writable, or the result has no such field",
     "make the folder, or name another with `-o`; nothing was left half-written"},
    {an_error, "io-error", "a library that reads or writes the file failed",
     "the message has its words", "try another format"},
    {an_error, "unknown-format", "the extension is not read or written as what is needed here",
     "formats are told by the extension",
     "[formats](../reference/formats.md); Python hands unknown files to trimesh or meshio"},
    {an_error, "unsupported-file", "the file uses a part of its format that is not read or written",
     "the message says which", "save it in the way that the message names, or in another format"},
    {an_error, "bad-file", "a file is damaged, cut off or not of its format",
     "the message gives line or byte, what was expected and what was found",
     "correct that place, or export the file again"},
    // What is in them.
    {an_error, "no-such-element", "a vertex, face, edge or point of this number does not exist",
     "an index is out of range",
     "the message says how many there are; check whether counting starts at 0 or 1 "
     "(`--index-base`)"},
    {an_error, "not-finite", "a coordinate or value is NaN or infinite",
     "the message names the vertex or node", "remove or correct it; `littoral info` counts them"},
    {an_error, "sizes-differ", "there are more or fewer values than elements",
     "arrays that belong together have different lengths", "give one value for each element"},
    {an_error, "empty-input", "no faces, no points, no area or no extent",
     "nothing is left to compute with", "`littoral info` shows what the file holds"},
    {an_error, "no-normals", "the input has no faces, and its points have no normals",
     "without either there is no inside", "`--estimate-normals`"},
    {an_error, "no-inside", "the input encloses nothing",
     "it is a sheet, is reversed, or is thinner than the grid",
     "`--flip`, or a larger `--resolution`"},
    {an_error, "volume-meaning",
     "the values of a volume are neither a mask nor signed distance, or a mask has its inside "
     "along "
     "its border",
     "what they mean, or which side is inside, cannot be told from the numbers",
     "`--as mask`, `--as distance` or `--as density`, or `--redistance`; of a mask `--as mask`, or "
     "`--flip` where 0 is inside"},
    {an_error, "nothing-there", "a level, box, slice, part or pattern meets nothing",
     "the field does not take the value, or the box lies beside the input",
     "`littoral info` shows ranges of values and boxes"},
    {an_error, "no-field", "a file has no values to work with, or several fields",
     "nothing says which values are meant", "`--field NAME`; the message lists those there are"},
    {an_error, "no-path", "no path over the mesh joins two nodes of a curve",
     "the curve runs from one component to another",
     "split the curve, or weld the mesh: `littoral convert --weld`"},
    // The machine.
    {an_error, "too-large", "memory or numbering does not suffice",
     "seen before the work where possible", "a coarser mesh or a smaller `--resolution`"},
    {an_error, "time-limit", "stopped after the time limit", "`--time-limit` did its work",
     "raise it, or a smaller `--resolution`; `--dry-run` estimates"},
    {an_error, "solve-failed", "a linear system could not be solved",
     "the input is beyond double precision somewhere",
     "remove needles and faces of very different size; otherwise report it with the input"},
    {an_error, "diverged", "an iteration diverged: non-finite iterate",
     "the same, in an iterative solver", "the same; larger `--alpha` helps `regularized`"},
    {an_error, "tetgen-failed", "tetgen is missing, failed or ended too late",
     "it is another program", "install it, or leave `--domain tets` to the lattice"},
    {an_error, "system", "a process, thread or port cannot be opened",
     "the operating system refused", "free some, or fewer `--jobs`"},
    {an_error, "internal", "an error that nobody foresaw", "a fault of littoral",
     "report it with the input"},
    {an_error, "cancelled", "the computation was stopped", "the caller asked for it", "nothing"},

    // What was asked for.
    {a_warning, "decimal-comma", "a list of two numbers may have been meant as one",
     "commas separate numbers, decimals stand behind a point: 0,5 is 0 and 5",
     "write 0.5, or put a blank behind the comma"},
    // Curves and surfaces.
    {a_warning, "completion-guessed",
     "more of the zero set completes the curves, or the surface in tets, than they make up "
     "themselves",
     "much of them is missing; which side is which is a guess there",
     "`--confidence` shows where; draw more"},
    {a_warning, "curve-leaps", "segments join nodes that share no face and are far apart",
     "shortest paths were taken; the order of nodes may be wrong",
     "check the curve; split it where it ends"},
    {a_warning, "curve-split", "a curve was split where it jumps between components of the mesh",
     "its closest points lie on different components", "check that it belongs to this mesh"},
    {a_warning, "curve-crosses-itself", "jumps of the residual function could not be bounded",
     "the curve crosses itself", "take crossings apart where regions matter"},
    {a_warning, "source-moved", "a curve or point was moved to lie on the surface",
     "it was given in space, and off the surface",
     "see how far; is it for this mesh, and in this unit?"},
    {a_warning, "source-shadowed", "a source has a value above what other sources give there",
     "values may differ by no more than the distance between their sources",
     "lower the value, or leave the source out"},
    {a_warning, "tets-folded", "neighbouring tets lie on the same side of the face they share",
     "one is folded over the other, so that what is within the mesh is not clear there",
     "make the mesh again, or move the vertices until no tet is turned inside out"},
    {a_warning, "sources-outside", "sources lie outside the tets and were left out",
     "the tets do not hold them", "move them, or fill a larger box"},
    {a_warning, "pieces-left-out", "parts of sources were left out",
     "they have no length, no sides, or lie on faces without area", "nothing"},
    {a_warning, "pieces-lost", "tiny pieces of curves were lost to rounding",
     "they are shorter than numbers resolve", "nothing"},
    {a_warning, "nonbounding-kept", "parts of curves that bound nothing are kept",
     "this formulation does not tell them apart", "formulation `primal` or `dual`"},
    {a_warning, "nonmanifold-edges", "edges have more than two faces",
     "the surface was taken apart there", "`--formulation dual` goes on across them"},
    {a_warning, "flipped-faces", "faces are oriented against the majority of their neighbours",
     "the majority won", "nothing, or orient the faces"},
    {a_warning, "not-orientable", "the surface, or the band along a curve, has one side",
     "signs are local, and change somewhere", "`--discontinuous` lets the distance jump"},
    {a_warning, "component-unreached", "components hold no source; their distance is infinite",
     "nothing reaches them",
     "add sources, weld vertices (`littoral convert --weld 0.001%`), or ignore them"},
    {a_warning, "isolated-vertices", "vertices belong to no face; their distance is infinite",
     "no path reaches them", "ignore or remove them"},
    {a_warning, "degenerate-faces", "faces repeat a vertex or have no area",
     "they were left out, or had their sides lengthened minimally",
     "nothing; `--intrinsic-delaunay` for accuracy"},
    {a_warning, "polygons-cut", "polygons were cut into triangles",
     "they have very many corners or come back to one, or an option needs triangles", "nothing"},
    {a_warning, "sign-ignored", "signed curves count as unsigned ones", "`exact` has no signs",
     "method `auto` has"},
    {a_warning, "normals-cancel", "the normals of the sources cancel everywhere",
     "each source has its reverse at the same place; the distance is zero",
     "leave one of the two out"},
    {a_warning, "directions-misaligned",
     "the distance falls along the diffused directions on part of the surface",
     "sources contradict each other, or the time scale is too small",
     "leave `--time-scale` out; make sources consistent"},
    {a_warning, "time-scale-raised", "the time scale was raised",
     "with the smaller one heat was lost in round-off", "leave `--time-scale` out"},
    {a_warning, "gradient-off-unit",
     "the gradient of the distance is off unit length on part of the surface",
     "the mesh is too coarse or uneven for this method",
     "method `auto`, or `--intrinsic-delaunay`"},
    {a_warning, "far-from-marching", "the distance is far from that of fast marching",
     "the mesh is too coarse or uneven for this method",
     "method `auto`, or `--intrinsic-delaunay`"},
    {a_warning, "direction-missing", "elements have no direction",
     "heat does not reach them, or none was given there",
     "a longer `--time-scale`; distances far away are less exact"},
    {a_warning, "far-from-exact", "distances between pairs are a tenth of the largest off, or more",
     "`symmetric` smooths, and triangles are as large as what they show",
     "`--method exact`, or a smaller `--alpha`"},
    {a_warning, "curvature-raised", "the Hessian energy was made convex by a larger curvature",
     "the surface has saddles, where that energy is negative, and `--alpha` is large",
     "a smaller `--alpha`, or another regularizer; the answer is smoother in its gradient"},
    {a_warning, "constraints-unmet", "the constraints could not be met exactly",
     "curves cross in one face; the result is a least-squares fit",
     "`--constraint none`, or `--soft`"},
    {a_warning, "not-converged", "an iteration stopped before its tolerance",
     "the answer is its best iterate; the report has the residual",
     "a larger `--max-iterations` or looser `--tolerance` where the method has them"},
    {a_warning, "level-missed", "there is nothing at a level",
     "values do not reach it; the message has their range", "another level"},
    {a_warning, "option-without-effect", "an option was not followed",
     "it has no meaning for this file or these triangles", "leave it out"},

    // Space.
    {a_warning, "nothing-enclosed", "the input encloses nothing, so there is no inside",
     "a sheet, or too many faces are missing, double or reversed",
     "method `signed-heat` closes consistently oriented sheets"},
    {a_warning, "orientation-mixed", "the orientation of faces disagrees, or faces are double",
     "faces were turned by lines through the input; the message has shares",
     "orient faces to be sure, or see whether `signed-heat` agrees"},
    {a_warning, "orientation-reversed", "most normals point into the space that the input encloses",
     "the mesh is inside out; it was taken as reversed", "nothing; `--flip` for the other way"},
    {a_warning, "sheets", "part of the input's area has the outside on both sides",
     "sheets, or double or reversed faces; signs are uncertain there",
     "orient faces, fill holes, or see whether `signed-heat` agrees"},
    {a_warning, "walls-inside", "part of the input's area lies inside, on both sides",
     "walls within, or parts that overlap", "remove them to measure to the outer surface alone"},
    {a_warning, "sign-uncertain", "signs are uncertain in places",
     "the sign changes where there is no surface, lines disagree about the orientation, or the "
     "method and `auto` differ",
     "`--confidence` shows where; method `auto`"},
    {a_warning, "points-not-enclosing", "the points do not enclose what they bound",
     "the surface through them goes on beyond them", "more points, or a smaller box"},
    {a_warning, "free-edges", "patches over holes end a spacing before the faces",
     "there are very many free edges, mostly unwelded vertices",
     "`littoral convert --weld 0.001%`"},
    {a_warning, "normals-estimated", "the point cloud has no normals; they were estimated",
     "the outside, or the left of curves, may be the wrong side", "give normals, or `--flip`"},
    {a_warning, "normals-unusable", "points were left out for their normals",
     "normals are zero, not finite, or cancel at one place", "correct the normals"},
    {a_warning, "points-coincide", "points coincide with others; each place was used once",
     "double points", "nothing"},
    {a_warning, "outliers", "points were taken for outliers, or none could be",
     "`--drop-outliers` did its work", "check how many; leave it out if points are missing"},
    {a_warning, "samples-outside", "samples of the input lie outside the box",
     "the box is too small", "`--bounds`, `--padding`"},
    {a_warning, "box-misses-input", "the box holds no sample of the input",
     "distances are shifted by the value at its centre", "`--bounds` around the input"},
    {a_warning, "grid-unplaced", "a volume holds no origin and spacing",
     "lengths are in units of its nodes", "VTK image data, NRRD and `.npz` hold them"},
    {a_warning, "thin-parts", "parts or gaps are thinner than the spacing of the grid",
     "contours miss or tear them", "the resolution that the message names"},
    {a_warning, "open-surface", "a surface is open: it meets the boundary of the box or the tets",
     "the box is smaller than the result", "a larger `--padding` or `--bounds`, or `--clip`"},
    {a_warning, "wall-thin", "a wall is thinner than the grid resolves, or solid",
     "its two surfaces meet or vanish", "a larger `--resolution`, or another thickness"},
    {a_warning, "accuracy-missed", "the result is farther off than what was asked for",
     "the grid is too coarse", "a larger `--resolution`"},
    {a_warning, "parts-lost", "part of the input's area is not part of the result",
     "sheets without an inside, or parts thinner than the grid",
     "`--thicken`, or a larger `--resolution`"},
    {a_warning, "sheets-thickened", "the input encloses nothing, and its faces became walls",
     "it is a sheet, or thinner than the grid",
     "`--thicken` says how thick; a larger `--resolution` finds thin parts; `--flip` if reversed"},
    {a_warning, "result-unsound", "the result has open edges or faces that cross",
     "the contour could not be made sound at this resolution", "another `--resolution`"},
});

std::string message_section(const char* title, Message::Kind kind) {
  std::string text = std::string("\n## ") + title +
                     "\n\n| code | what it says | why | what to do |\n|---|---|---|---|\n";
  for (const Message& each : message_table)
    if (each.kind == kind)
      text += std::string("| `") + each.code + "` | " + each.about + " | " + each.meaning + " | " +
              each.remedy + " |\n";
  return text;
}

}  // namespace

std::span<const Message> messages() { return message_table; }

std::string messages_markdown() {
  return "# Messages by their codes\n\n"
         "An error or a warning is one line, and ends with its code in brackets:\n\n"
         "```text\n"
         "littoral: error: bunny.obj:1023: face refers to vertex 99999, the file has 14290 "
         "[bad-file]\n"
         "```\n\n"
         "Codes stay the same when the wording changes. They are `code` in reports (`--json` and"
         " JavaScript)\nand the attribute `code` of Python's errors and of the texts in "
         "`.warnings`. A warning\ndoes not change the exit status. `littoral help --messages` "
         "prints this page; for results that are\nwrong without a message see "
         "[Troubleshooting](troubleshooting.md).\n" +
         message_section("Errors", an_error) + message_section("Warnings", a_warning);
}

}  // namespace littoral
