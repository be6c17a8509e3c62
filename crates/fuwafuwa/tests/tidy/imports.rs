//! Dependencies between the source files of a crate.
//!
//! A file depends on another one if a path in its code, tests excluded, leads to an item that is defined
//! there, directly or through re-exports. Declaring a module or re-exporting from it is not a dependency.
//! Neither is a method call: methods belong to their type, wherever they are defined.

use std::collections::{BTreeMap, BTreeSet};

/// Path of a module below the root of its crate.
type Module = Vec<String>;
/// Files of a crate with their names, by module.
type Files = BTreeMap<Module, (String, File)>;

/// A source file, parsed.
#[derive(Default)]
struct File {
    tokens: Vec<String>,
    defined: BTreeSet<String>,
    /// Names imported by `use`: local name, path, and whether the name is re-exported.
    brought: Vec<(String, Vec<String>, bool)>,
    /// Paths in code.
    paths: Vec<Vec<String>>,
}

/// Returns the dependencies of each file of a crate. `files` has the name below the source folder and the
/// text of each file.
pub fn imports(files: &[(String, String)]) -> BTreeMap<String, BTreeSet<String>> {
    let read = |(name, text): &(String, String)| (module_of(name), (name.clone(), File::of(text)));
    let files: Files = files.iter().map(read).collect();
    let found = files.iter().map(|(module, (name, file))| {
        let repeated = |word: &str| file.tokens.iter().filter(|token| *token == word).count() > 1;
        let brought = file.brought.iter();
        let brought = brought.filter(|(word, _, is_handed_on)| !is_handed_on || repeated(word));
        let paths = brought.map(|(_, path, _)| path).chain(&file.paths);
        let uses = paths.filter_map(|path| definer(&files, module, path, 0));
        let others = uses.filter(|other| other != module);
        (
            name.clone(),
            others.map(|other| files[&other].0.clone()).collect(),
        )
    });
    found.collect()
}

/// Repeatedly removes files that depend on no other file or on which no other file depends. The result is
/// empty if and only if there are no cycles.
pub fn tangle(
    mut imports: BTreeMap<String, BTreeSet<String>>,
) -> BTreeMap<String, BTreeSet<String>> {
    loop {
        let before = imports.len();
        let used: BTreeSet<String> = imports.values().flatten().cloned().collect();
        imports.retain(|file, others| !others.is_empty() && used.contains(file));
        let left: BTreeSet<String> = imports.keys().cloned().collect();
        for others in imports.values_mut() {
            others.retain(|other| left.contains(other));
        }
        if imports.len() == before {
            return imports;
        }
    }
}

/// Returns the module of a file.
fn module_of(file: &str) -> Module {
    let path = file.trim_end_matches(".rs").split('/').map(str::to_string);
    let mut path: Module = path.collect();
    let last = path.last().expect("a file has a name").as_str();
    if last == "mod" || path.len() == 1 && ["lib", "main"].contains(&last) {
        path.pop();
    }
    path
}

/// Returns the module that defines the target of a path, as seen from module `from`; `None` outside the
/// crate.
fn definer(files: &Files, from: &Module, path: &[String], detours: usize) -> Option<Module> {
    let (mut at, mut rest) = (from.clone(), path);
    while let Some((first, after)) = rest.split_first() {
        match first.as_str() {
            "crate" => at.clear(),
            "super" => at.truncate(at.len().saturating_sub(1)),
            "self" => {}
            _ => break,
        }
        rest = after;
    }
    while let Some((first, after)) = rest.split_first() {
        let child = [at.as_slice(), std::slice::from_ref(first)].concat();
        if !files.contains_key(&child) {
            break;
        }
        (at, rest) = (child, after);
    }
    let (first, after) = rest.split_first()?;
    let file = &files.get(&at)?.1;
    if first == "*" || file.defined.contains(first) {
        return Some(at);
    }
    // A crate with the name of one of its modules would lead back here endlessly.
    let mut brought = file.brought.iter().filter(|_| detours < 8);
    brought.find_map(|(word, source, _)| match word.as_str() {
        _ if word == first => definer(files, &at, &[source, after].concat(), detours + 1),
        "*" if rest.len() < path.len() => {
            let source = &source[..source.len() - 1];
            definer(files, &at, &[source, rest].concat(), detours + 1)
        }
        _ => None,
    })
}

impl File {
    fn of(text: &str) -> Self {
        let mut file = Self {
            tokens: without_tests(tokens(text)),
            ..Self::default()
        };
        let mut depth = 0;
        let mut at = 0;
        while at < file.tokens.len() {
            let next = file.tokens.get(at + 1).cloned().unwrap_or_default();
            match file.tokens[at].as_str() {
                "{" => depth += 1,
                "}" => depth -= 1,
                // Not the `use` of `impl Trait + use<>`.
                "use" if next != "<" => {
                    let is_handed_on = at > 0 && ["pub", ")"].contains(&&*file.tokens[at - 1]);
                    let end = file.tokens[at..].iter().position(|token| token == ";");
                    let end = at + end.expect("a semicolon ends each use declaration");
                    let mut leaves = Vec::new();
                    use_tree(&file.tokens[at + 1..end], &[], &mut leaves);
                    let leaves = leaves.into_iter();
                    let leaves = leaves.map(|(word, path)| (word, path, is_handed_on));
                    file.brought.extend(leaves);
                    at = end;
                }
                "fn" | "struct" | "enum" | "trait" | "type" | "const" | "static" | "mod"
                | "macro_rules"
                    if depth == 0 =>
                {
                    file.defined.insert(next);
                }
                word if is_word(word) && next == "::" => {
                    let mut path = vec![word.to_string()];
                    while file.tokens.get(at + 1).is_some_and(|token| token == "::")
                        && file.tokens.get(at + 2).is_some_and(|token| is_word(token))
                    {
                        path.push(file.tokens[at + 2].clone());
                        at += 2;
                    }
                    file.paths.push(path);
                }
                _ => {}
            }
            at += 1;
        }
        file
    }
}

/// Collects the names of a `use` tree, each with its path.
fn use_tree(tree: &[String], before: &[String], leaves: &mut Vec<(String, Vec<String>)>) {
    let Some(open) = tree.iter().position(|token| token == "{") else {
        let words = tree.iter().take_while(|token| *token != "as");
        let words = words.filter(|token| *token != "::").cloned();
        let words = words.filter(|token| *token != "self" || before.is_empty());
        let path: Vec<String> = before.iter().cloned().chain(words).collect();
        let name = tree.last().filter(|last| *last != "self").or(path.last());
        leaves.push((
            name.expect("a use tree has at least one name").clone(),
            path,
        ));
        return;
    };
    let words = tree[..open].iter().filter(|token| *token != "::").cloned();
    let before: Vec<String> = before.iter().cloned().chain(words).collect();
    let (mut depth, mut start) = (0, open + 1);
    for at in open..tree.len() {
        match tree[at].as_str() {
            "{" => depth += 1,
            "}" => depth -= 1,
            _ => {}
        }
        let ends = depth == 1 && tree[at] == "," || depth == 0;
        if ends && start < at {
            use_tree(&tree[start..at], &before, leaves);
        }
        if ends {
            start = at + 1;
        }
    }
}

fn is_word(token: &str) -> bool {
    token.starts_with(|c: char| c.is_alphabetic() || c == '_')
}

/// Splits a source into words and signs, with `::` as one token, without comments and strings.
fn tokens(text: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let length = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if let Some(inner) = rest.strip_prefix("r#\"") {
            inner.find("\"#").expect("a string ends") + 5
        } else if first == '"' {
            string_length(rest)
        } else if first == '\'' {
            character_length(rest)
        } else if is_word(rest) {
            let end = rest.find(|c: char| !c.is_alphanumeric() && c != '_');
            let end = end.unwrap_or(rest.len());
            found.push(rest[..end].to_string());
            end
        } else if rest.starts_with("::") {
            found.push("::".to_string());
            2
        } else {
            if !first.is_whitespace() {
                found.push(first.to_string());
            }
            first.len_utf8()
        };
        rest = &rest[length..];
    }
    found
}

fn string_length(text: &str) -> usize {
    let mut is_escaped = false;
    for (at, c) in text.char_indices().skip(1) {
        match c {
            _ if is_escaped => is_escaped = false,
            '\\' => is_escaped = true,
            '"' => return at + 1,
            _ => {}
        }
    }
    text.len()
}

/// Returns the length of a character literal or of a lifetime's mark.
fn character_length(text: &str) -> usize {
    let mut inner = text[1..].chars();
    match (inner.next(), inner.next()) {
        (Some('\\'), _) => 3 + text[3..].find('\'').expect("a character ends") + 1,
        (Some(c), Some('\'')) => 2 + c.len_utf8(),
        _ => 1,
    }
}

/// Drops each item after `#[cfg(test)]`, up to its closing brace or semicolon.
fn without_tests(tokens: Vec<String>) -> Vec<String> {
    let mark = ["#", "[", "cfg", "(", "test", ")", "]"];
    let mut kept = Vec::new();
    let mut at = 0;
    while at < tokens.len() {
        if !tokens[at..].starts_with(&mark.map(str::to_string)) {
            kept.push(tokens[at].clone());
            at += 1;
            continue;
        }
        let mut depth = 0;
        loop {
            match tokens[at].as_str() {
                "{" => depth += 1,
                "}" => depth -= 1,
                _ => {}
            }
            let ends = depth == 0 && ["}", ";"].contains(&tokens[at].as_str());
            at += 1;
            if ends {
                break;
            }
        }
    }
    kept
}

#[test]
fn tangle_finds_import_cycles() {
    let check = |files: &[(&str, &str)], expect: &[&str]| {
        let files = files
            .iter()
            .map(|(name, text)| (name.to_string(), text.to_string()));
        let tangled = tangle(imports(&files.collect::<Vec<_>>()));
        assert_eq!(tangled.into_keys().collect::<Vec<_>>(), expect);
    };
    let a = ("a.rs", "use crate::{b::B, c};\npub struct A(B);");
    check(&[a, ("b.rs", "pub struct B;")], &[]);
    check(
        &[a, ("b.rs", "use super::a::A;\npub struct B(A);")],
        &["a.rs", "b.rs"],
    );
    check(
        &[
            a,
            (
                "b.rs",
                "pub struct B; // crate::a::A\nconst TEXT: &str = \"crate::a::A\";",
            ),
        ],
        &[],
    );
    let tests = "pub struct B;\n#[cfg(test)]\nmod tests { use crate::a::A; }";
    check(&[a, ("b.rs", tests)], &[]);
    let root = ("lib.rs", "mod a;\nmod b;\npub use a::A;");
    let through_root = ("b.rs", "pub struct B(Option<Box<crate::A>>);");
    check(&[root, a, through_root], &["a.rs", "b.rs"]);
    let child = ("a/child.rs", "use super::A;\npub fn act(_: A) {}");
    let declares = ("a.rs", "mod child;\npub use child::act;\npub struct A;");
    check(&[declares, child], &[]);
    let calls = (
        "a.rs",
        "mod child;\npub struct A;\nfn run() { child::act(A) }",
    );
    check(&[calls, child], &["a.rs", "a/child.rs"]);
    let ring = [
        ("a.rs", "use crate::b::*;\nstruct A;"),
        ("b.rs", "use crate::c::C;\npub struct B;"),
        ("c.rs", "use crate::a;\npub struct C(a::A);"),
    ];
    check(&ring, &["a.rs", "b.rs", "c.rs"]);
    let by_module =
        "use crate::b::{self};\npub struct A;\nfn run() -> impl Sized + use<> { b::run() }";
    let b = "pub struct B;\npub fn run() { crate::a::A; }";
    check(&[("a.rs", by_module), ("b.rs", b)], &["a.rs", "b.rs"]);
}
