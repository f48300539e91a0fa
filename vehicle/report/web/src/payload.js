// Read the data of the page: JSON, with arrays as base64 of 32-bit differences.

/** The data of this page, arrays decoded to 64-bit floats. */
export function readPayload() {
  const data = JSON.parse(document.getElementById("payload").textContent);
  for (const point of Object.values(data.points)) point.values = unpack(point);
  data.spin_axis.values = unpack(data.spin_axis);
  data.gaps = data.gaps.map(unpack);
  const samples = Object.fromEntries(
    Object.entries(data.samples).map(([key, packed]) => [key, unpack(packed)]),
  );
  for (const curve of data.curves) {
    curve.values = samples[curve.samples];
    curve.gaps = curve.jumps ? data.gaps : [];
  }
  if (data.motion) {
    for (const name of ["travel", "rack", "spin"]) data.motion[name] = unpack(data.motion[name]);
    for (const signal of data.motion.signals) signal.values = unpack(signal);
  }
  return data;
}

/** Decode one array; its design value, or one for each component, is added back. */
function unpack({ design, differences }) {
  const bytes = Uint8Array.from(atob(differences), (letter) => letter.charCodeAt(0));
  const view = new DataView(bytes.buffer);
  const offsets = Array.isArray(design) ? design : [design];
  const values = new Float64Array(bytes.length / 4);
  for (let i = 0; i < values.length; i += 1) {
    values[i] = view.getFloat32(4 * i, true) + offsets[i % offsets.length];
  }
  return values;
}
