//! Level generators: they work on any valid game.
