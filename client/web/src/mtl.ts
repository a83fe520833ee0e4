// Material libraries of OBJ files (.mtl) as glTF materials, by the rules of the command line (client/lib/material_library).

type Colour = [number, number, number];

/// Images of a material, by glTF's members.
export interface MaterialImages {
  baseColorTexture?: string;
  metallicRoughnessTexture?: string;
  normalTexture?: string;
  emissiveTexture?: string;
}

/// Material of a library. Images are names of files, with / in paths.
export interface LibraryMaterial {
  name: string;
  baseColorFactor: [number, number, number, number];
  emissive: Colour;
  metallicFactor: number;
  roughnessFactor: number;
  isBlended: boolean;
  images: MaterialImages;
}

/// Values by lower-case keyword.
type Values = Map<string, string>;

/// Reads a library. Skips options of maps and unknown keywords.
export function readMtl(text: string): LibraryMaterial[] {
  const materials: { name: string; values: Values }[] = [];
  for (const line of text.replace(/^\ufeff/, '').split(/\r?\n/)) {
    const [, keyword = '', rest = ''] = /^\s*(\S+)\s*(.*?)\s*$/.exec(line.replace(/#.*/, '')) ?? [];
    if (keyword === 'newmtl') materials.push({ name: rest, values: new Map() });
    else materials.at(-1)?.values.set(keyword.toLowerCase(), rest);
  }
  return materials.map(({ name, values }) => materialOf(name, values));
}

/// Returns a material that no library defines: white.
export const undefinedMaterial = (name: string) => materialOf(name, new Map());

function materialOf(name: string, values: Values): LibraryMaterial {
  const [diffuse, emissive, roughness, metallic, normal, opacity] = [
    'map_kd',
    'map_ke',
    'map_pr',
    'map_pm',
    'norm',
    'map_d',
  ].map((keyword) => fileName(values.get(keyword) ?? ''));
  const hasChannels = roughness !== undefined && roughness === metallic;
  const alpha = Math.min(
    numberOf(values.get('d')?.replace(/^-halo\s+/, '')) ?? 1 - (numberOf(values.get('tr')) ?? 0),
    1,
  );
  const [red, green, blue] = (colourOf(values.get('kd')) ?? [1, 1, 1]).map((x) => Math.min(x, 1));
  const exponent = numberOf(values.get('ns')) ?? 0;
  return {
    name,
    baseColorFactor: [red, green, blue, alpha],
    emissive: colourOf(values.get('ke')) ?? (emissive === undefined ? [0, 0, 0] : [1, 1, 1]),
    metallicFactor: Math.min(numberOf(values.get('pm')) ?? (hasChannels ? 1 : 0), 1),
    // Roughness of the microfacet model whose highlight is as wide as that of the Phong exponent.
    roughnessFactor: Math.min(numberOf(values.get('pr')) ?? (hasChannels ? 1 : Math.sqrt(2 / (exponent + 2))), 1),
    isBlended: alpha < 1 || opacity !== undefined,
    images: {
      baseColorTexture: diffuse,
      emissiveTexture: emissive,
      normalTexture: normal,
      metallicRoughnessTexture: hasChannels ? roughness : undefined,
    },
  };
}

/// Returns a number of at least 0; nothing for other text.
function numberOf(text: string | undefined): number | undefined {
  const number = Number.parseFloat(text ?? '');
  return Number.isFinite(number) ? Math.max(number, 0) : undefined;
}

/// Returns a colour: three numbers, or one for all.
function colourOf(text: string | undefined): Colour | undefined {
  const [red, green, blue] = (text ?? '').split(/\s+/).map(numberOf);
  return red === undefined ? undefined : [red, green ?? red, blue ?? red];
}

/// Numbers of arguments of the options of maps, at most.
const mapOptions: Record<string, number> = { mm: 2, o: 3, s: 3, t: 3 };

/// Returns the name after the options of a map.
function fileName(text: string): string | undefined {
  const words = text.split(/\s+/);
  while (words.length > 1 && /^-[a-z]+$/i.test(words[0])) {
    const most = mapOptions[words.shift()!.slice(1).toLowerCase()] ?? 1;
    for (let i = 0; i < most && words.length > 1 && (i === 0 || numberLike(words[0])); ++i) words.shift();
  }
  const name = words.join(' ').replace(/^"(.*)"$/, '$1');
  return name === '' ? undefined : name.replaceAll('\\', '/');
}

const numberLike = (word: string) => /^[-+.\d]/.test(word) && Number.isFinite(Number(word));
