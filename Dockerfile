# One static binary and nothing else: `docker build -t tigereye .`
FROM rust:slim AS build
RUN apt-get update && apt-get install --yes --no-install-recommends musl-tools && rm -rf /var/lib/apt/lists/*
WORKDIR /tigereye
COPY . .
# The tool chain of rust-toolchain.toml is installed first.
RUN rustup target add "$(uname -m)-unknown-linux-musl" \
    && cargo build --release --locked --package tigereye-cli --target "$(uname -m)-unknown-linux-musl" \
    && cp "target/$(uname -m)-unknown-linux-musl/release/tigereye" /bin/tigereye

FROM scratch
COPY --from=build /bin/tigereye /tigereye
ENTRYPOINT ["/tigereye"]
