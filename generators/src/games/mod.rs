//! Game generators: rules, mapping and fiction.
