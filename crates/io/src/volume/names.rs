//! What the names of components say: which entry of a tensor each one is.
//!
//! Programs spell them `XX`, `xx`, `11`, `00`, `S11`, `SXX`, `sigma_xx`, `stress_XX`, `S-XY`, `(1,2)`. The two index
//! characters are read, and what stands before or after them is not: the quantity's own name differs between normal and
//! shear components (`sigma_xx`, `tau_xy`).

use super::order::TensorOrder;

/// What the names of an array's components mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Naming {
    /// There are none, or none that say anything.
    Unnamed,
    /// Entries of a tensor.
    Tensor(TensorOrder),
    /// Principal values or others without directions: `Min`, `Mid`, `Max`, `Sigma 1`.
    Principal,
    /// Names that are none of these, such as `X`, `Y`, `Z` of a vector.
    Other,
}

/// An index pair as it is spelt.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Pair([char; 2]);

impl Pair {
    fn of(a: char, b: char) -> Option<Self> {
        let letter = |c| matches!(c, 'x' | 'y' | 'z');
        let digit = |c| matches!(c, '0'..='3');
        (letter(a) && letter(b) || digit(a) && digit(b)).then_some(Self([a, b]))
    }

    /// Row-major index of the entry; digits count from `first`.
    fn entry(self, first: u32) -> Option<usize> {
        let index = |c: char| match c {
            'x' => Some(0),
            'y' => Some(1),
            'z' => Some(2),
            _ => c.to_digit(10)?.checked_sub(first).filter(|&i| i < 3),
        };
        Some(3 * index(self.0[0])? as usize + index(self.0[1])? as usize)
    }
}

/// Lower-case runs of letters and digits.
fn words_of(name: &str) -> Vec<String> {
    let name = name.to_lowercase().replace('∂', "d");
    name.split(|c: char| !c.is_alphanumeric()).filter(|w| !w.is_empty()).map(str::to_owned).collect()
}

/// The pair of a derivative, `dudx`, `du_dy`, `dvx/dx`, `∂v/∂y`: component before direction, as rows and columns of a
/// gradient.
fn derivative_of(words: &[String]) -> Option<(Pair, String)> {
    let letters: Vec<char> = words.concat().chars().collect();
    let is_d = |c: &char| *c == 'd';
    let [first, component @ .., second, direction] = &letters[..] else { return None };
    if !(is_d(first) && is_d(second)) {
        return None;
    }
    let component = match component {
        ['u' | 'x'] => 'x',
        ['v' | 'y'] => 'y',
        ['w' | 'z'] => 'z',
        ['u' | 'v', axis] => *axis,
        _ => return None,
    };
    Some((Pair::of(component, *direction)?, "gradient".to_owned()))
}

/// The index pair at the end of a name, or alone at its beginning, and what stands before it (or after it).
fn pair_of(name: &str) -> Option<(Pair, String)> {
    let words = words_of(name);
    if let Some(derivative) = derivative_of(&words) {
        return Some(derivative);
    }
    let rest = |kept: &[String]| kept.join("_");
    let (last, before) = words.split_last()?;
    let letters: Vec<char> = last.chars().collect();
    if let [single] = letters[..]
        && let Some((other, stem)) = before.split_last()
        && let Some(pair) = other.chars().next().filter(|_| other.chars().count() == 1)
        && let Some(pair) = Pair::of(pair, single)
    {
        return Some((pair, rest(stem)));
    }
    if let [stem @ .., a, b] = &letters[..]
        && let Some(pair) = Pair::of(*a, *b)
        // `xxx` and `s111` are no pairs.
        && stem.last().is_none_or(|c| Pair::of(*c, *b).is_none())
    {
        let stem: String = stem.iter().collect();
        let all: Vec<String> = before.iter().cloned().chain((!stem.is_empty()).then_some(stem)).collect();
        return Some((pair, rest(&all)));
    }
    // `XX stress`.
    let (first, behind) = words.split_first()?;
    let [a, b] = first.chars().collect::<Vec<_>>()[..] else { return None };
    Some((Pair::of(a, b)?, rest(behind)))
}

/// Names as entries of a tensor, row by row; `None` where one of them is no index pair, or where the digits count from
/// nowhere.
fn entries_of(pairs: &[Pair]) -> Option<Vec<usize>> {
    let has = |digit: char| pairs.iter().any(|p| p.0.contains(&digit));
    let first = match (has('0'), has('3')) {
        (true, true) => return None,
        (true, false) => 0,
        _ => 1,
    };
    pairs.iter().map(|p| p.entry(first)).collect()
}

/// Words for values that have no direction.
const MAGNITUDES: [&str; 10] =
    ["min", "mid", "max", "minimum", "middle", "maximum", "intermediate", "worst", "principal", "eigenvalue"];
/// What principal values are called where a number says which.
const NUMBERED: [&str; 9] = ["sigma", "s", "p", "e", "eps", "lambda", "l", "ev", "principal"];

/// Whether a name is that of a principal value: `Min`, `Sigma 1`, `lambda_2`, `S3`.
fn is_principal(name: &str) -> bool {
    let words = words_of(name);
    let joined = words.concat();
    let numbered = joined.strip_suffix(['1', '2', '3']).is_some_and(|stem| NUMBERED.contains(&stem));
    numbered || joined == "sigma" || words.iter().any(|w| MAGNITUDES.contains(&w.trim_end_matches('s')))
}

/// What the names of the components of one array say.
pub(crate) fn naming(names: &[String], components: usize) -> Naming {
    if names.len() != components || names.iter().all(|n| n.trim().is_empty()) {
        return Naming::Unnamed;
    }
    if let Some(order) = order_of(names) {
        return Naming::Tensor(order);
    }
    if names.iter().all(|n| is_principal(n)) { Naming::Principal } else { Naming::Other }
}

/// The order that names of all components spell.
pub(crate) fn order_of<S: AsRef<str>>(names: &[S]) -> Option<TensorOrder> {
    TensorOrder::by_entries(&entries(names)?).ok()
}

/// The entries that names spell, row by row. Where some are pairs, `SX` beside `SXY` is a normal component, as Ansys
/// has it.
pub(crate) fn entries<S: AsRef<str>>(names: &[S]) -> Option<Vec<usize>> {
    let pair = |name: &S| pair_of(name.as_ref()).map(|(pair, _)| pair);
    let has_pairs = names.iter().any(|n| pair(n).is_some());
    let single = |name: &S| normal_of(name.as_ref()).filter(|_| has_pairs).map(|(pair, _)| pair);
    let pairs: Option<Vec<Pair>> = names.iter().map(|n| pair(n).or_else(|| single(n))).collect();
    entries_of(&pairs?)
}

/// The pair of a name that ends with one letter, `SX`, and what stands before it.
fn normal_of(name: &str) -> Option<(Pair, String)> {
    let mut words = words_of(name);
    let letter = words.last_mut()?.pop().filter(|c| c.is_alphabetic())?;
    words.retain(|w| !w.is_empty());
    Some((Pair::of(letter, letter)?, words.join("_")))
}

/// Whether an array called so holds principal values: `S_Principal`, `eigenvalues`.
pub(crate) fn names_principal_values(array: &str) -> bool {
    words_of(array).iter().any(|w| matches!(w.as_str(), "principal" | "eigenvalues" | "eigenvalue" | "evals"))
}

/// Whether an array called so holds eigenvectors, whose rows are no tensor: `evecs`, `eigenvectors`.
pub(crate) fn names_eigenvectors(array: &str) -> bool {
    const NAMES: [&str; 8] =
        ["evec", "evecs", "eigvec", "eigvecs", "eigenvector", "eigenvectors", "directions", "axes"];
    words_of(array).iter().any(|w| NAMES.contains(&w.as_str()))
}

/// Whether a name is that of a strain, whose shears may be engineering ones: `strain`, `TOSTRAIN`, `eps_xy`,
/// `gamma_xy`, `E11`, `LE12`.
pub(crate) fn names_strain(name: &str) -> bool {
    name.split(", ").any(is_strain)
}

fn is_strain(name: &str) -> bool {
    let words = words_of(name);
    let short = pair_of(name).or_else(|| normal_of(name)).map(|(_, stem)| stem).unwrap_or_default();
    let is = |w: &str| {
        let word = w.trim_end_matches('s');
        word.starts_with("strain")
            || word.ends_with("strain")
            || matches!(w, "eps" | "epsilon" | "gamma" | "ε" | "γ")
    };
    // Abaqus repeats what is asked for: `LE.LE11`, `E:E11`.
    let last = short.rsplit('_').next().unwrap_or_default();
    let stem = if last.is_empty() { words.concat() } else { last.to_owned() };
    words.iter().any(|w| is(w)) || is(&stem) || STRAINS.contains(&stem.as_str())
}

/// What Abaqus calls its strains and rates of strain (Output variable identifiers), and Ansys its own.
const STRAINS: [&str; 18] = [
    "e", "le", "ne", "ee", "pe", "ce", "ie", "ve", "the", "er", "cke", "epto", "epel", "eppl", "epth",
    "epcr", "eptt", "epdi",
];

/// A group of arrays of single numbers that are the components of one tensor.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Group {
    /// Indices of the arrays among those asked about.
    pub(crate) members: Vec<usize>,
    /// The entries they are.
    pub(crate) order: TensorOrder,
}

/// What shear components are called, and the normal components of the same quantity.
const SHEARS: [(&[&str], &[&str]); 2] = [
    (&["tau", "τ", "t"], &["sigma", "σ", "sig", "s", "stress"]),
    (&["gamma", "γ", "gam", "g"], &["eps", "ε", "epsilon", "e", "strain"]),
];

/// Whether shears of one name and normal components of another, `tau` and `sigma`, are one quantity's; what stands
/// before these words, as in `plate_sigma`, is the same then.
fn are_one_quantity(normal: &str, shear: &str) -> bool {
    let split = |stem: &str| {
        let (before, last) = stem.rsplit_once('_').unwrap_or(("", stem));
        (before.to_owned(), last.to_owned())
    };
    let ((before, normal), (before_shear, shear)) = (split(normal), split(shear));
    let fits = |(shears, normals): &(&[&str], &[&str])| {
        shears.contains(&shear.as_str()) && normals.contains(&normal.as_str())
    };
    before == before_shear && SHEARS.iter().any(fits)
}

/// Names that share what stands before their index pairs.
struct Stem {
    name: String,
    members: Vec<usize>,
    pairs: Vec<Pair>,
}

impl Stem {
    fn add(all: &mut Vec<Self>, name: String, member: usize, pair: Pair) {
        match all.iter_mut().find(|stem| stem.name == name) {
            Some(stem) => {
                stem.members.push(member);
                stem.pairs.push(pair);
            }
            None => all.push(Self { name, members: vec![member], pairs: vec![pair] }),
        }
    }

    /// Whether all entries are on the diagonal, or all off it.
    fn holds(&self, diagonal: bool) -> bool {
        self.pairs.iter().all(|pair| (pair.0[0] == pair.0[1]) == diagonal)
    }

    fn take(&mut self, other: Self) {
        self.members.extend(other.members);
        self.pairs.extend(other.pairs);
    }
}

/// Arrays called `S_XX`, `S_YY`, `S_XY` are one tensor: the groups of names that share what stands before their index
/// pairs, or whose shears have their own name (`sigma_x`, `sigma_y`, `tau_xy`).
pub(crate) fn groups(names: &[&str]) -> Vec<Group> {
    let (mut stems, mut singles) = (Vec::new(), Vec::new());
    for (at, name) in names.iter().enumerate() {
        if let Some((pair, stem)) = pair_of(name) {
            Stem::add(&mut stems, stem, at, pair);
        } else if let Some((pair, stem)) = normal_of(name) {
            Stem::add(&mut singles, stem, at, pair);
        }
    }
    // `SX` beside `SXY` is a normal component, as Ansys has it.
    let mut others = Vec::new();
    for single in singles {
        let fits = |stem: &&mut Stem| {
            stem.name == single.name && stem.pairs.iter().all(|p| !single.pairs.contains(p))
        };
        match stems.iter_mut().find(fits) {
            Some(stem) => stem.take(single),
            None => others.push(single),
        }
    }
    stems.extend(others);
    // Normal components that lack their shears take those of another name, where only one fits.
    let normals: Vec<String> = stems.iter().filter(|s| s.holds(true)).map(|s| s.name.clone()).collect();
    let normals_of = |shear: &str| {
        let mut found = normals.iter().filter(|normal| are_one_quantity(normal, shear));
        found.next().filter(|_| found.next().is_none())
    };
    let (shears, mut stems): (Vec<Stem>, Vec<Stem>) = stems.into_iter().partition(|s| s.holds(false));
    for shear in shears {
        match normals_of(&shear.name).and_then(|name| stems.iter_mut().find(|s| s.name == *name)) {
            Some(normal) if normal.holds(true) => normal.take(shear),
            _ => stems.push(shear),
        }
    }
    let group = |stem: Stem| {
        let mut all: Vec<(usize, Pair)> = stem.members.into_iter().zip(stem.pairs).collect();
        all.sort_unstable_by_key(|(member, _)| *member);
        let (members, pairs): (Vec<usize>, Vec<Pair>) = all.into_iter().unzip();
        let order = TensorOrder::by_entries(&entries_of(&pairs)?).ok()?;
        Some(Group { members, order })
    };
    stems.into_iter().filter_map(group).collect()
}

/// The axes of vectors: in space, and in the planes of two of its axes.
pub(crate) const VECTOR_AXES: [&[&str]; 4] = [&["x", "y", "z"], &["x", "y"], &["x", "z"], &["y", "z"]];

/// The axes, 0 to 2, that the components of vectors are along by their names: `X` and `Z`, `u` and `w`, `Ux` and `Uz`.
pub(crate) fn axes_of_vectors(names: &[String]) -> Option<Vec<usize>> {
    let axis = |name: &String| match words_of(name).concat().chars().last()? {
        'x' | 'u' => Some(0),
        'y' | 'v' => Some(1),
        'z' | 'w' => Some(2),
        _ => None,
    };
    let axes: Option<Vec<usize>> = names.iter().map(axis).collect();
    axes.filter(|axes| (0..axes.len()).all(|i| !axes[..i].contains(&axes[i])))
}

/// The arrays of numbers that are no components of a tensor: `exx` and `exy` beside `eyy` are not those of a vector.
pub(crate) fn outside_tensors(names: &[&str]) -> Vec<usize> {
    let of_tensors: Vec<usize> = groups(names).into_iter().flat_map(|group| group.members).collect();
    (0..names.len()).filter(|i| !of_tensors.contains(i)).collect()
}

/// Arrays of vectors called `T_x`, `T_y`, `T_z` are the rows of one tensor, arrays of numbers called so the components
/// of one vector: the indices of the arrays of every group of exactly these axes, in the order of the axes.
pub(crate) fn row_groups(names: &[&str], axes: &[&str]) -> Vec<Vec<usize>> {
    let mut stems: Vec<(String, Vec<(char, usize)>)> = Vec::new();
    for (at, name) in names.iter().enumerate() {
        let words = match *name {
            // Velocities are called so.
            "u" | "U" => "velocity_x".to_owned(),
            "v" | "V" => "velocity_y".to_owned(),
            "w" | "W" => "velocity_z".to_owned(),
            _ => words_of(name).join("_"),
        };
        // Numbers count eigenvectors or times.
        let Some(last) = words.chars().last().filter(|c| matches!(c, 'x' | 'y' | 'z')) else { continue };
        let stem = words[..words.len() - last.len_utf8()].trim_end_matches('_').to_owned();
        // `x` and `y` alone are positions, `d_dx` is the column of a gradient.
        if stem.is_empty() || stem.ends_with('d') {
            continue;
        }
        match stems.iter_mut().find(|(s, _)| *s == stem) {
            Some((_, members)) => members.push((last, at)),
            None => stems.push((stem, vec![(last, at)])),
        }
    }
    let complete = |(_, mut members): (String, Vec<(char, usize)>)| {
        members.sort_unstable();
        let letters: String = members.iter().map(|m| m.0).collect();
        (axes.concat() == letters).then(|| members.into_iter().map(|m| m.1).collect())
    };
    stems.into_iter().filter_map(complete).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(names: &str) -> Naming {
        let names: Vec<String> = names.split(' ').map(str::to_owned).collect();
        naming(&names, names.len())
    }

    #[test]
    fn every_spelling_of_an_index_pair_is_read() {
        let voigt = TensorOrder::parse("xx,yy,zz,yz,xz,xy", 6).map(Naming::Tensor);
        for names in [
            "XX YY ZZ YZ XZ XY",
            "xx yy zz yz xz xy",
            "11 22 33 23 13 12",
            "00 11 22 12 02 01",
            "S11 S22 S33 S23 S13 S12",
            "SXX SYY SZZ SYZ SXZ SXY",
            "sigma_xx sigma_yy sigma_zz tau_yz tau_xz tau_xy",
            "stress_XX stress_YY stress_ZZ stress_YZ stress_XZ stress_XY",
            "S-11 S-22 S-33 S-32 S-31 S-21",
            "(1,1) (2,2) (3,3) (2,3) (1,3) (1,2)",
            "s.x.x s.y.y s.z.z s.y.z s.x.z s.x.y",
            "σxx σyy σzz τyz τxz τxy",
            "XX-stress YY-stress ZZ-stress YZ-stress XZ-stress XY-stress",
            "SX SY SZ SYZ SXZ SXY",
        ] {
            assert_eq!(Ok(named(names)), voigt, "{names}");
        }
        let gradient = TensorOrder::parse("xx,xy,yx,yy", 4).map(Naming::Tensor);
        for names in [
            "dudx dudy dvdx dvdy",
            "du/dx du/dy dv/dx dv/dy",
            "dUx_dx dUx_dy dUy_dx dUy_dy",
            "∂u/∂x ∂u/∂y ∂v/∂x ∂v/∂y",
        ] {
            assert_eq!(Ok(named(names)), gradient, "{names}");
        }
        let plane = TensorOrder::parse("xx,yy,xy", 3).map(Naming::Tensor);
        for names in ["11 22 12", "00 11 01", "max_xx max_yy max_xy"] {
            assert_eq!(Ok(named(names)), plane, "{names}");
        }
    }

    #[test]
    fn names_without_directions_are_no_tensor() {
        for names in [
            "Min Mid Max Worst",
            "Sigma-1 Sigma-2 Sigma-3",
            "S1 S2 S3",
            "lambda_1 lambda_2 lambda_3",
            "Max Min",
        ] {
            assert_eq!(named(names), Naming::Principal, "{names}");
        }
        for names in
            ["X Y Z", "u v w", "a b c", "XX XX YY", "XX YY ZZ", "00 33 03", "xxx xxy xyy", "S111 S222 S121"]
        {
            assert_eq!(named(names), Naming::Other, "{names}");
        }
        assert_eq!(naming(&[], 3), Naming::Unnamed);
        assert_eq!(naming(&vec![String::new(); 3], 3), Naming::Unnamed);
    }

    #[test]
    fn names_tell_the_axes_of_vectors() {
        let axes = |names: [&str; 2]| axes_of_vectors(&names.map(str::to_owned));
        for names in [["X", "Z"], ["u", "w"], ["U_x", "U_z"], ["velocity u", "velocity w"]] {
            assert_eq!(axes(names), Some(vec![0, 2]), "{names:?}");
        }
        assert_eq!(axes(["w", "v"]), Some(vec![2, 1]));
        for names in [["a", "b"], ["x", "x"], ["", ""], ["0", "1"]] {
            assert_eq!(axes(names), None, "{names:?}");
        }
    }

    #[test]
    fn separate_arrays_are_grouped_by_what_their_names_share() {
        let found = groups(&["S_XX", "pressure", "S_YY", "E_XX", "S_XY", "E_YY"]);
        assert_eq!(found.len(), 1, "E has no shear: {found:?}");
        assert_eq!(found[0].members, [0, 2, 4]);
        let ansys = groups(&["SXY", "UX", "SX", "SY"]);
        assert_eq!((ansys.len(), &ansys[0].members[..]), (1, &[0, 2, 3][..]));
        for names in [
            ["sigma_xx", "sigma_yy", "tau_xy"],
            ["sxx", "syy", "txy"],
            ["sx", "sy", "txy"],
            ["sigma_x", "sigma_y", "tauxy"],
            ["σxx", "σyy", "τxy"],
            ["plate sig_x", "plate sig_y", "plate tau_xy"],
            ["stress_xx", "stress_yy", "tau_xy"],
            ["eps_xx", "eps_yy", "gamma_xy"],
            ["ex", "ey", "gxy"],
        ] {
            let found = groups(&names);
            assert_eq!((found.len(), found[0].order.to_string()), (1, "xx,yy,xy".to_owned()), "{names:?}");
            assert_eq!(found[0].members, [0, 1, 2]);
            let is_strain = names[0].starts_with('e');
            assert_eq!(names.iter().any(|n| names_strain(n)), is_strain, "{names:?}");
        }
        // Two quantities to which shears could belong, and shears that are there already.
        assert!(groups(&["sigma_xx", "sigma_yy", "stress_xx", "stress_yy", "tau_xy"]).is_empty());
        let own = groups(&["sigma_xx", "sigma_yy", "sigma_xy", "tau_xy"]);
        assert_eq!((own.len(), &own[0].members[..]), (1, &[0, 1, 2][..]));
        let rows = row_groups(&["T_y", "grad", "T_x", "T_z"], VECTOR_AXES[0]);
        assert_eq!(rows, [[2, 0, 3]]);
        let gradient = groups(&["u", "dvdy", "dvdx", "dudy", "dudx"]);
        assert_eq!((gradient.len(), gradient[0].order.to_string()), (1, "yy,yx,xy,xx".to_owned()));
        assert!(row_groups(&["u_x", "u_y"], VECTOR_AXES[0]).is_empty());
        for others in [["V1", "V2", "V3"], ["vel_0", "vel_1", "vel_2"], ["d_dx", "d_dy", "d_dz"]] {
            assert!(row_groups(&others, VECTOR_AXES[0]).is_empty(), "{others:?}");
        }
        assert_eq!(row_groups(&["x", "y", "u", "v"], VECTOR_AXES[1]), [[2, 3]]);
        assert_eq!(row_groups(&["w", "p", "u"], VECTOR_AXES[2]), [[2, 0]]);
        assert!(row_groups(&["u", "v", "w"], VECTOR_AXES[2]).is_empty());
    }

    /// Components of tensors are no vectors, even if two of them end in x and y; vectors beside them are.
    #[test]
    fn components_of_tensors_are_no_vectors() {
        for tensor in [
            ["exx", "eyy", "exy"],
            ["SX", "SY", "SXY"],
            ["sigma_x", "sigma_y", "tau_xy"],
            ["ex", "ey", "exy"],
            ["Sxx", "Syy", "Sxy"],
        ] {
            let names = ["U", tensor[0], tensor[1], "V", tensor[2]];
            assert_eq!(outside_tensors(&names), [0, 3], "{tensor:?}");
        }
        for vector in [["velocity_x", "velocity_y", "velocity_z"], ["u", "v", "w"], ["Ux", "Uy", "Uz"]] {
            assert_eq!(outside_tensors(&vector), [0, 1, 2], "{vector:?}");
        }
    }

    #[test]
    fn strains_are_known_by_name() {
        for name in [
            "strain",
            "TOSTRAIN",
            "eps_xy",
            "gamma_xy",
            "E11",
            "LE12",
            "plastic_strain_xx",
            "E",
            "LE11, LE22, LE12",
            "EPTOXY",
            "LE.LE11",
            "LE-LE12",
            "LE_LE22",
            "E:E11, E:E22, E:E12",
            "CE",
            "CE-CE11, CE-CE22, CE-CE12",
            "IE12",
            "ER_ER33",
            "VE.VE12",
            "CKE11",
            "EPCRXY",
        ] {
            assert!(names_strain(name), "{name}");
        }
        for name in ["stress", "S11", "sigma_xx", "energy", "constrained", "force", "PEEQ", "shape11"] {
            assert!(!names_strain(name), "{name}");
        }
    }
}
