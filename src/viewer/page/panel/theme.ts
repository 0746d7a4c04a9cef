import { Color } from 'three';

/** Colours of the picture, but for those of the bodies. */
export interface Theme {
  background: Color;
  obstacle: Color;
  floor: Color;
  /** The floor is multiplied by it along the lines of its grid. */
  grid: Color;
  spring: Color;
  particle: Color;
  pin: Color;
  contact: Color;
  force: Color;
  velocity: Color;
  mark: Color;
  drag: Color;
}

export const LIGHT: Theme = {
  background: new Color('#f4f5f7'),
  obstacle: new Color('#98a0ad'),
  floor: new Color('#e3e5e9'),
  grid: new Color('#a9b0bc'),
  spring: new Color('#33404f'),
  particle: new Color('#1d2733'),
  pin: new Color('#1b2a41'),
  contact: new Color('#d55e00'),
  force: new Color('#b5179e'),
  velocity: new Color('#1f8a4c'),
  mark: new Color('#d0021b'),
  drag: new Color('#1d2733'),
};

export const DARK: Theme = {
  background: new Color('#14171c'),
  obstacle: new Color('#828b99'),
  floor: new Color('#3a3e45'),
  grid: new Color(2.2, 2.3, 2.5),
  spring: new Color('#c3ccd8'),
  particle: new Color('#e6ebf2'),
  pin: new Color('#f2f5fa'),
  contact: new Color('#ff9142'),
  force: new Color('#ff85d0'),
  velocity: new Color('#74d99f'),
  mark: new Color('#ff4d4d'),
  drag: new Color('#e6ebf2'),
};

const darkQuery = window.matchMedia('(prefers-color-scheme: dark)');

/** Light or dark: as the system has it, until the user chooses. */
export class ThemeChoice {
  private chosen: 'light' | 'dark' | null = null;

  constructor(private readonly changed: (theme: Theme) => void) {
    darkQuery.addEventListener('change', () => this.apply());
  }

  toggle(): void {
    this.chosen = this.dark ? 'light' : 'dark';
    this.apply();
  }

  apply(): void {
    document.documentElement.dataset.theme = this.dark ? 'dark' : 'light';
    this.changed(this.dark ? DARK : LIGHT);
  }

  private get dark(): boolean {
    return this.chosen ? this.chosen === 'dark' : darkQuery.matches;
  }
}
