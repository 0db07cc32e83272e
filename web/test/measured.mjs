// Everything that is compared with the program, computed by the package: in Node as it is, in a page
// from its text.
export async function measured(littoral, { files, cases, queries, regionSources }) {
  const bytes = (name) => Uint8Array.from(files[name]);
  const surfaces = {};
  for (const name of Object.keys(files)) surfaces[name] = await littoral.loadSurface(bytes(name), name);
  const fields = [];
  for (const { surface, name, sources, method, options } of cases) {
    const on = surfaces[surface];
    const solver = await on.prepare({ name: method, options });
    const stages = [];
    const from = await on.readSources(sources, name);
    const field = await solver.solve(from, { onProgress: (fraction, stage) => stages.push([fraction, stage]) });
    // As text and back, the sources give the same to the last bit.
    const again = await on.readSources(await on.writeSources(from, "again.txt"), "again.txt");
    const second = await solver.solve(again);
    fields.push({
      values: Array.from(field.values), same: second.values.every((x, i) => Object.is(x, field.values[i])),
      refined: field.refined && { vertices: field.refined.positions.length / 3, values: field.refined.scalars.distance.length },
      method: field.report.method, progress: stages.at(-1)?.[0],
    });
    solver.dispose();
  }
  const spot = surfaces["spot.obj"];
  const { region } = await spot.regions(await spot.readSources(regionSources.text, regionSources.name));
  const distances = [], sdfs = {};
  for (const name of ["spot.obj", "sphere.xyz"]) {
    const sdf = await surfaces[name].signedDistance();
    distances.push(Array.from(await sdf.at(queries.flat())));
    sdfs[name] = sdf.bounds;
    sdf.dispose();
  }
  const kinds = Object.values(surfaces).map((s) => s.kind);
  for (const surface of Object.values(surfaces)) surface.dispose();
  return { fields, region: Array.from(region), distances, bounds: sdfs, kinds };
}
