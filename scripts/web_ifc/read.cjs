// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads IFC files with web-ifc and prints what each product's triangles enclose: node read.cjs FILE.ifc ...
// One JSON object: file -> [{ kind, tag, parts, volume (mm3), low and high corner (mm, z up) }].
"use strict";
const fs = require("fs");
const { IfcAPI, LogLevel } = require("web-ifc");

const CIRCLE_SEGMENTS = 64;
const MM = 1000; // web-ifc gives metres
const FLOATS_OF_A_VERTEX = 6; // place and normal

// a column-major 4 x 4 matrix applied to a point; web-ifc's y points up
function placed(m, x, y, z) {
  const at = (row) => MM * (m[row] * x + m[4 + row] * y + m[8 + row] * z + m[12 + row]);
  return [at(0), -at(2), at(1)];
}

function sixfoldVolume(a, b, c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
}

function measured(api, model, mesh) {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  const parts = mesh.geometries.size();
  let volume = 0;
  for (let part = 0; part < parts; part += 1) {
    const { geometryExpressID, flatTransformation } = mesh.geometries.get(part);
    const geometry = api.GetGeometry(model, geometryExpressID);
    const vertices = api.GetVertexArray(geometry.GetVertexData(), geometry.GetVertexDataSize());
    const corners = api.GetIndexArray(geometry.GetIndexData(), geometry.GetIndexDataSize());
    const points = [];
    for (let i = 0; i < vertices.length; i += FLOATS_OF_A_VERTEX) {
      const point = placed(flatTransformation, vertices[i], vertices[i + 1], vertices[i + 2]);
      points.push(point);
      point.forEach((value, axis) => {
        low[axis] = Math.min(low[axis], value);
        high[axis] = Math.max(high[axis], value);
      });
    }
    // counted from a point of the body: far from the origin the terms would cancel badly
    const local = (i) => points[corners[i]].map((value, axis) => value - points[corners[0]][axis]);
    for (let i = 0; i < corners.length; i += 3) volume += sixfoldVolume(local(i), local(i + 1), local(i + 2)) / 6;
    geometry.delete();
  }
  return { parts, volume, low, high };
}

async function main(paths) {
  const api = new IfcAPI();
  await api.Init();
  api.SetLogLevel(LogLevel.LOG_LEVEL_OFF);
  const files = {};
  for (const path of paths) {
    const model = api.OpenModel(new Uint8Array(fs.readFileSync(path)), { CIRCLE_SEGMENTS });
    if (model < 0) throw new Error(`${path}: web-ifc cannot open it`);
    const products = [];
    api.StreamAllMeshes(model, (mesh) => {
      const line = api.GetLine(model, mesh.expressID);
      const tag = line.Tag ? line.Tag.value : `#${mesh.expressID}`;
      products.push({ kind: api.GetNameFromTypeCode(line.type), tag, ...measured(api, model, mesh) });
    });
    files[path] = products;
    api.CloseModel(model);
  }
  process.stdout.write(JSON.stringify(files));
}

main(process.argv.slice(2)).catch((error) => {
  process.stderr.write(`${error.message}\n`);
  process.exitCode = 1;
});
