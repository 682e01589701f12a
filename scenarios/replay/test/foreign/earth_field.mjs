// Prints the earth's magnetic field by somebody else's implementation of the World Magnetic Model, one line for each line of
// standard input: `decimal-year altitude-km latitude-deg longitude-deg` gives `declination-deg inclination-deg nanotesla`.

import { readFileSync } from "node:fs";
import geomagnetism from "geomagnetism";

for (const line of readFileSync(0, "utf8").trim().split("\n")) {
  const [year, altitude, latitude, longitude] = line.split(" ").map(Number);
  const begin = Date.UTC(Math.floor(year), 0, 1);
  const end = Date.UTC(Math.floor(year) + 1, 0, 1);
  const date = new Date(begin + (year - Math.floor(year)) * (end - begin));
  const field = geomagnetism.model(date, { allowOutOfBoundsModel: true }).point([latitude, longitude, altitude]);
  console.log(`${field.decl} ${field.incl} ${field.f}`);
}
