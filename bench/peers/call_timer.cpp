// Calls through the public header, one for each line of the standard input, for python_overhead.py.
// usage: littoral_call_timer MESH QUERIES
//        QUERIES: doubles as the machine has them, 3 a point
// A line is TASK REPEATS; the answer is processor seconds of a call on one thread, and the sum of
// the values.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <iostream>
#include <map>
#include <string>

#include "io/read.h"
#include "littoral/littoral.h"

using namespace littoral;

int main(int count, char** words) {
  if (count != 3) {
    std::fprintf(stderr, "usage: littoral_call_timer MESH QUERIES\n");
    return 2;
  }
  Context context;
  context.threads = 1;
  const Mesh mesh = read_mesh(words[1]);
  const std::string bytes = io::read_bytes(words[2]);
  MatX3 queries(static_cast<Eigen::Index>(bytes.size() / sizeof(double) / 3), 3);
  std::copy_n(bytes.data(), bytes.size(), reinterpret_cast<char*>(queries.data()));
  const MatX3 few = queries.topRows(1);
  const DistanceSolver heat(mesh, AnyMethod::named("unsigned-heat", {}), context);
  const DistanceSolver quadratic(mesh, AnyMethod::named("quadratic", {}), context);
  const Sdf sdf = signed_distance(mesh, {}, {}, context);
  const Sources source(SurfacePoint::at_vertex(0));
  const std::map<std::string, std::function<double()>> tasks{
      {"unsigned-heat", [&] { return heat.solve(source, context).values.sum(); }},
      {"quadratic", [&] { return quadratic.solve(source, context).values.sum(); }},
      {"points", [&] { return sdf.at(queries, context).sum(); }},
      {"point", [&] { return sdf.at(few, context).sum(); }}};
  std::string task;
  int repeats = 0;
  while (std::cin >> task >> repeats) {
    double sum = 0;
    const std::clock_t begin = std::clock();
    for (int k = 0; k < repeats; ++k) sum = tasks.at(task)();
    std::printf("%.9f %.17g\n", double(std::clock() - begin) / CLOCKS_PER_SEC / repeats, sum);
    std::fflush(stdout);
  }
  return 0;
}
